#pragma once
// What a study report reads: one list of named tables, each one SELECT over one study.
// A table's name is its name everywhere: in JSON, in the page, and in the figures' specs.

#include <cstdint>
#include <string_view>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::storage {

struct ReportQuery {
    std::string_view table;
    std::string_view meaning;
    std::string_view sql;  // ?1 is the study_id
};

const std::vector<ReportQuery>& report_queries();

// The database must have been opened with open_read_only. An unknown study gives empty tables.
QueryResult read_report_table(Database& database, const ReportQuery& query, std::int64_t study_id);

}  // namespace capstan::storage
