#pragma once
// All tables of one study, read at once.

#include "capstan/reports/table.h"
#include "capstan/storage/database.h"

namespace capstan::reports {

class StudyTables : public Tables {
  public:
    StudyTables(storage::Database& database, std::int64_t study_id);

    Row study() const { return (*this)["study"].each().front(); }
};

}  // namespace capstan::reports
