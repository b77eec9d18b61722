#pragma once
// Rows as a Parquet file: version 1 of the format, uncompressed, PLAIN values, one page a column and row
// group. What any reader of the format understands, written without a library.

#include <string>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::reports {

enum class ParquetType { whole, real, text };  // INT64, DOUBLE, BYTE_ARRAY of UTF-8

struct ParquetColumn {
    std::string name;
    ParquetType type = ParquetType::real;
};

// `rows`: rows x columns; NULL may stand anywhere, and whole numbers in real columns. A value of another type
// is a std::invalid_argument that names its column.
std::string parquet_file(const std::vector<ParquetColumn>& columns,
                         const std::vector<std::vector<storage::QueryValue>>& rows);

}  // namespace capstan::reports
