#pragma once
// Two studies of one database compared: the differences of their configurations, their recommendations, and
// the errors of the layouts and methods that both have. Reads only; an unknown study is a storage::Error.

#include <cstdint>

#include "capstan/reports/answer.h"
#include "capstan/storage/database.h"

namespace capstan::reports {

struct ComparedStudies {
    std::int64_t first = 0;  // study_id
    std::int64_t second = 0;
};

Answer study_comparison(storage::Database& database, const ComparedStudies& studies);

}  // namespace capstan::reports
