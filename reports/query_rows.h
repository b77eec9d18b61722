#pragma once
// The rows of a query as text and as JSON.

#include <string>
#include <vector>

#include "capstan/reports/data.h"
#include "capstan/storage/read_only_query.h"

namespace capstan::reports {

/// A cell of a row.
Data data_of_cell(const storage::QueryValue& value);

/// The rows as columns side by side, numbers to the right in six digits.
std::string rows_text(const storage::QueryResult& result);
/// The rows as a JSON array of objects, one object after the other.
std::string rows_json(const storage::QueryResult& result);
/// One of those objects, indented as it stands in the array.
std::string row_json(const std::vector<std::string>& columns, const std::vector<storage::QueryValue>& row);

}  // namespace capstan::reports
