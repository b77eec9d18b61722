#pragma once
// The report of a study in every format. Every function only reads; the database must have been opened with
// storage::Database::open_read_only. An unknown study is a storage::Error.

#include <cstdint>
#include <string>

#include "capstan/storage/database.h"

namespace capstan::reports {

// One page that needs no network: recommendation first, then the figures and tables it rests on.
std::string study_report_html(storage::Database& database, std::int64_t study_id);

// The same for a page that `capstan serve` sends: style and scripts are separate files, and live.js is added.
std::string study_live_html(storage::Database& database, std::int64_t study_id);

// Facts, recommendations, best errors and the comparison with the paper, as tables.
std::string study_report_markdown(storage::Database& database, std::int64_t study_id);

// All tables of storage::report_queries(), in full precision: {"table": [{"column": value, ...}, ...], ...}.
std::string study_report_json(storage::Database& database, std::int64_t study_id);

// The table error_by_layout: the error of every layout family, number of sensors and method.
std::string study_error_csv(storage::Database& database, std::int64_t study_id);

}  // namespace capstan::reports
