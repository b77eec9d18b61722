#pragma once
// Rows as a Parquet file, written as they come: version 1 of the format, uncompressed, PLAIN values, one page
// a column and row group. What any reader of the format understands, written without a library.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::reports {

enum class ParquetType { whole, real, text };  // INT64, DOUBLE, BYTE_ARRAY of UTF-8

struct ParquetColumn {
    std::string name;
    ParquetType type = ParquetType::real;
};

class ParquetWriter {
  public:
    using Sink = std::function<void(std::string_view bytes)>;  // what goes into the file, in its order

    ParquetWriter(std::vector<ParquetColumn> columns, Sink sink);

    // NULL may stand anywhere, and whole numbers in real columns. A value of another type is a
    // std::invalid_argument that names its column.
    void add(std::vector<storage::QueryValue> row);

    void finish();  // without it there is no file

  private:
    struct Chunk {
        std::size_t offset = 0;
        std::size_t bytes = 0;
    };
    struct Group {
        std::size_t rows = 0;
        std::vector<Chunk> chunks;  // columns
    };

    void write_group();
    Chunk write_chunk(std::size_t column);
    void append_group(std::string& footer, const Group& group) const;
    void write(std::string_view bytes);

    std::vector<ParquetColumn> columns_;
    Sink sink_;
    std::vector<std::vector<storage::QueryValue>> rows_;  // of the group under way
    std::vector<Group> groups_;
    std::size_t written_rows_ = 0;
    std::size_t written_bytes_ = 0;
};

}  // namespace capstan::reports
