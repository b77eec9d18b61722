#pragma once

#include <string>

#include "capstan/storage/read_only_query.h"

namespace capstan::cli {

/// Columns side by side, numbers to the right in six digits, for people.
std::string as_table(const storage::QueryResult& result);
/// RFC 4180 with a head line; numbers in full precision, nothing for NULL.
/// An array of objects, numbers in full precision.
std::string as_json(const storage::QueryResult& result);

}  // namespace capstan::cli
