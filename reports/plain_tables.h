#pragma once
// Tables as plain text for programs and documents.

#include <string>
#include <vector>

#include "capstan/reports/experiment_page.h"
#include "capstan/reports/table.h"

namespace capstan::reports {

std::string table_csv(const Table& table);  // RFC 4180 with a head line, in full precision

// {"table": [{"column": value, ...}, ...], ...}
std::string tables_json(const std::vector<Table>& tables);

// A heading and the rows below it.
std::string markdown_of(const NumberTable& numbers);

// A study's words must not become a table's border or a tag.
std::string escape_markdown(const std::string& text);

}  // namespace capstan::reports
