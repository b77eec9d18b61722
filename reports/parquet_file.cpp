#include "capstan/reports/parquet_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "capstan/reports/thrift_compact.h"

namespace capstan::reports {
namespace {

using storage::QueryValue;
using Rows = std::vector<std::vector<QueryValue>>;

static_assert(std::endian::native == std::endian::little);  // as Parquet's values are

constexpr const char* magic = "PAR1";
constexpr std::size_t rows_in_a_group = 500'000;
// Numbers of the format's enumerations.
constexpr int plain = 0, rle = 3, optional = 1, uncompressed = 0, utf8 = 0, data_page = 0;

int type_number(ParquetType type) {
    switch (type) {
        case ParquetType::whole:
            return 2;
        case ParquetType::real:
            return 5;
        case ParquetType::text:
            return 6;
    }
    return 0;
}

template <class Value>
void append(std::string& bytes, Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

bool is_null(const QueryValue& value) {
    return std::holds_alternative<std::monostate>(value);
}

void append_value(std::string& bytes, const ParquetColumn& column, const QueryValue& value) {
    const auto* whole = std::get_if<std::int64_t>(&value);
    const auto* real = std::get_if<double>(&value);
    const auto* text = std::get_if<std::string>(&value);
    if (column.type == ParquetType::whole && whole != nullptr) return append(bytes, *whole);
    if (column.type == ParquetType::real && real != nullptr) return append(bytes, *real);
    if (column.type == ParquetType::real && whole != nullptr)
        return append(bytes, static_cast<double>(*whole));
    if (column.type == ParquetType::text && text != nullptr) {
        append(bytes, static_cast<std::uint32_t>(text->size()));
        bytes += *text;
        return;
    }
    throw std::invalid_argument("column '" + column.name + "' holds values of more than one type");
}

// Which rows have a value: runs of equal levels (1: there), after their length in bytes.
std::string definition_levels(const Rows& rows, std::size_t column, std::size_t first, std::size_t end) {
    std::string runs;
    for (std::size_t row = first; row < end;) {
        const bool there = !is_null(rows[row][column]);
        std::size_t length = 1;
        while (row + length < end && !is_null(rows[row + length][column]) == there) ++length;
        for (std::uint64_t header = length << 1;; header >>= 7) {
            runs += static_cast<char>(header >= 0x80 ? header | 0x80 : header);
            if (header < 0x80) break;
        }
        runs += there ? '\1' : '\0';
        row += length;
    }
    std::string levels;
    append(levels, static_cast<std::uint32_t>(runs.size()));
    return levels + runs;
}

struct Chunk {
    std::size_t offset = 0;
    std::size_t bytes = 0;
};

// One column of one row group: a page's header and the page.
Chunk append_chunk(std::string& file, const ParquetColumn& column, const Rows& rows, std::size_t index,
                   std::size_t first, std::size_t end) {
    std::string page = definition_levels(rows, index, first, end);
    for (std::size_t row = first; row < end; ++row) {
        if (!is_null(rows[row][index])) append_value(page, column, rows[row][index]);
    }
    const Chunk chunk{file.size(), 0};
    ThriftWriter header(file);
    header.i32(1, data_page);
    header.i32(2, static_cast<std::int32_t>(page.size()));
    header.i32(3, static_cast<std::int32_t>(page.size()));
    header.structure(5);
    ThriftWriter inner(file);
    inner.i32(1, static_cast<std::int32_t>(end - first));
    inner.i32(2, plain);
    inner.i32(3, rle);
    inner.i32(4, rle);
    inner.end();
    header.end();
    file += page;
    return {chunk.offset, file.size() - chunk.offset};
}

struct Group {
    std::size_t rows = 0;
    std::vector<Chunk> chunks;  // columns
};

void append_schema(std::string& footer, const std::vector<ParquetColumn>& columns) {
    ThriftWriter root(footer);
    root.text(4, "schema");
    root.i32(5, static_cast<std::int32_t>(columns.size()));
    root.end();
    for (const ParquetColumn& column : columns) {
        ThriftWriter element(footer);
        element.i32(1, type_number(column.type));
        element.i32(3, optional);
        element.text(4, column.name);
        if (column.type == ParquetType::text) element.i32(6, utf8);
        element.end();
    }
}

void append_group(std::string& footer, const std::vector<ParquetColumn>& columns, const Group& group) {
    ThriftWriter writer(footer);
    writer.list(1, ThriftType::structure, columns.size());
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        const Chunk& chunk = group.chunks[k];
        bytes += chunk.bytes;
        ThriftWriter outer(footer);
        outer.i64(2, static_cast<std::int64_t>(chunk.offset));
        outer.structure(3);
        ThriftWriter about(footer);
        about.i32(1, type_number(columns[k].type));
        about.list(2, ThriftType::i32, 2);
        about.plain_i32(plain);
        about.plain_i32(rle);
        about.list(3, ThriftType::binary, 1);
        about.plain_text(columns[k].name);
        about.i32(4, uncompressed);
        about.i64(5, static_cast<std::int64_t>(group.rows));
        about.i64(6, static_cast<std::int64_t>(chunk.bytes));
        about.i64(7, static_cast<std::int64_t>(chunk.bytes));
        about.i64(9, static_cast<std::int64_t>(chunk.offset));
        about.end();
        outer.end();
    }
    writer.i64(2, static_cast<std::int64_t>(bytes));
    writer.i64(3, static_cast<std::int64_t>(group.rows));
    writer.end();
}

}  // namespace

std::string parquet_file(const std::vector<ParquetColumn>& columns, const Rows& rows) {
    std::string file = magic;
    std::vector<Group> groups;
    for (std::size_t first = 0; first < rows.size(); first += rows_in_a_group) {
        const std::size_t end = std::min(first + rows_in_a_group, rows.size());
        Group& group = groups.emplace_back();
        group.rows = end - first;
        for (std::size_t k = 0; k < columns.size(); ++k)
            group.chunks.push_back(append_chunk(file, columns[k], rows, k, first, end));
    }
    std::string footer;
    ThriftWriter about(footer);
    about.i32(1, 1);
    about.list(2, ThriftType::structure, columns.size() + 1);
    append_schema(footer, columns);
    about.i64(3, static_cast<std::int64_t>(rows.size()));
    about.list(4, ThriftType::structure, groups.size());
    for (const Group& group : groups) append_group(footer, columns, group);
    about.text(6, "capstan");
    about.end();
    file += footer;
    append(file, static_cast<std::uint32_t>(footer.size()));
    return file + magic;
}

}  // namespace capstan::reports
