#pragma once
// Two studies compared, of one database or of two: the differences of their configurations, their
// recommendations, and the errors of the layouts and methods that both have. Reads only; an unknown study is
// a storage::Error.

#include <cstdint>

#include "capstan/reports/answer.h"
#include "capstan/storage/database.h"

namespace capstan::reports {

struct ComparedStudy {
    storage::Database& database;
    std::int64_t study_id = 0;
};

/// Where the databases differ, the studies are named with their files.
Answer study_comparison(const ComparedStudy& first, const ComparedStudy& second);

}  // namespace capstan::reports
