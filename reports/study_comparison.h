#pragma once
// Two studies of one database compared: the differences of their configurations, their recommendations, and
// the errors of the layouts and methods that both have. Reads only; an unknown study is a storage::Error.

#include <cstdint>
#include <string>

#include "capstan/storage/database.h"

namespace capstan::reports {

struct ComparedStudies {
    std::int64_t first = 0;  // study_id
    std::int64_t second = 0;
};

std::string study_comparison_html(storage::Database& database, const ComparedStudies& studies);
std::string study_comparison_markdown(storage::Database& database, const ComparedStudies& studies);
std::string study_comparison_json(storage::Database& database,
                                  const ComparedStudies& studies);                              // every table
std::string study_comparison_csv(storage::Database& database, const ComparedStudies& studies);  // the errors

}  // namespace capstan::reports
