#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "capstan/storage/database.h"
#include "capstan/storage/schema_documentation.h"

namespace capstan::reports {

/// Writes a table or view to a file, row by row, since it may be larger than memory. `format`: csv, json or
/// parquet. Returns the number of rows. Throws std::runtime_error if the file cannot be written.
std::size_t write_table(storage::Database& database, const storage::DocumentedTable& table,
                        const std::filesystem::path& path, const std::string& format);

}  // namespace capstan::reports
