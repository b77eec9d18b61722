#pragma once
// Tables as plain text for programs and documents.

#include <string>
#include <vector>

#include "capstan/reports/table.h"

namespace capstan::reports {

// CSV as RFC 4180 has it, with one exception: lines end in \n, as other programs of this system write and
// expect them. The first line names the columns. Numbers are in full precision, and what is missing is an
// empty field.
std::string csv_head(const std::vector<std::string>& columns);
std::string csv_line(const std::vector<Value>& row);
std::string csv_text(const std::vector<std::string>& columns, const std::vector<std::vector<Value>>& rows);

// {"table": [{"column": value, ...}, ...], ...}
std::string tables_json(const std::vector<Table>& tables);

// A heading and rows below it, the first of which heads the columns.
std::string markdown_of(const std::string& heading, const std::vector<std::vector<std::string>>& cells);

// So that no text of a study acts as the border of a table or as a tag.
std::string escape_markdown(const std::string& text);

}  // namespace capstan::reports
