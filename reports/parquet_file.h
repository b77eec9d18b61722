#pragma once
// Rows as a Parquet file, written as they come: version 1 of the format, uncompressed, PLAIN values, one page
// a column and row group. Every reader of the format understands it.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::reports {

enum class ParquetType { integer, number, string };  // INT64, DOUBLE, BYTE_ARRAY of UTF-8

struct ParquetColumn {
    std::string name;
    ParquetType type = ParquetType::number;
};

class ParquetWriter {
  public:
    using Sink = std::function<void(std::string_view bytes)>;  // receives the bytes of the file in order

    ParquetWriter(std::vector<ParquetColumn> columns, Sink sink);

    // NULL may stand anywhere, and integers in columns of numbers. A value of another type is a
    // std::invalid_argument that names its column.
    void add(std::vector<storage::QueryValue> row);

    void finish();  // without it the file is incomplete

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
    std::vector<std::vector<storage::QueryValue>> rows_;  // of the current group
    std::vector<Group> groups_;
    std::size_t written_rows_ = 0;
    std::size_t written_bytes_ = 0;
};

}  // namespace capstan::reports
