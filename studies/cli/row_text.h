#pragma once

#include <string>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::cli {

/// The lines that as_csv() is made of.
std::string csv_head(const std::vector<std::string>& columns);
std::string csv_line(const std::vector<storage::QueryValue>& row);

/// One of the objects of as_json(), indented as it stands there.
std::string json_object(const std::vector<std::string>& columns, const std::vector<storage::QueryValue>& row);

}  // namespace capstan::cli
