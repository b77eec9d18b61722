#pragma once

#include <string>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::cli {

/// One of the objects of as_json(), indented as it stands there.
std::string json_object(const std::vector<std::string>& columns, const std::vector<storage::QueryValue>& row);

}  // namespace capstan::cli
