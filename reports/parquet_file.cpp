#include "capstan/reports/parquet_file.h"

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
constexpr std::size_t rows_in_a_group = 50'000;  // kept in memory
// Numbers of the format's enumerations.
constexpr int plain = 0, rle = 3, optional = 1, uncompressed = 0, utf8 = 0, data_page = 0;

int type_number(ParquetType type) {
    switch (type) {
        case ParquetType::integer:
            return 2;
        case ParquetType::number:
            return 5;
        case ParquetType::string:
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
    const auto* integer = std::get_if<std::int64_t>(&value);
    const auto* real = std::get_if<double>(&value);
    const auto* text = std::get_if<std::string>(&value);
    if (column.type == ParquetType::integer && integer != nullptr) return append(bytes, *integer);
    if (column.type == ParquetType::number && real != nullptr) return append(bytes, *real);
    if (column.type == ParquetType::number && integer != nullptr)
        return append(bytes, static_cast<double>(*integer));
    if (column.type == ParquetType::string && text != nullptr) {
        append(bytes, static_cast<std::uint32_t>(text->size()));
        bytes += *text;
        return;
    }
    throw std::invalid_argument("column '" + column.name + "' holds values of more than one type");
}

// Which rows have a value: runs of equal levels (1: present), after their length in bytes.
std::string definition_levels(const Rows& rows, std::size_t column) {
    std::string runs;
    for (std::size_t row = 0; row < rows.size();) {
        const bool there = !is_null(rows[row][column]);
        std::size_t length = 1;
        while (row + length < rows.size() && !is_null(rows[row + length][column]) == there) ++length;
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
        if (column.type == ParquetType::string) element.i32(6, utf8);
        element.end();
    }
}

}  // namespace

ParquetWriter::ParquetWriter(std::vector<ParquetColumn> columns, Sink sink)
    : columns_(std::move(columns)), sink_(std::move(sink)) {
    write(magic);
}

void ParquetWriter::write(std::string_view bytes) {
    sink_(bytes);
    written_bytes_ += bytes.size();
}

void ParquetWriter::add(std::vector<QueryValue> row) {
    rows_.push_back(std::move(row));
    if (rows_.size() == rows_in_a_group) write_group();
}

void ParquetWriter::write_group() {
    if (rows_.empty()) return;
    Group& group = groups_.emplace_back();
    group.rows = rows_.size();
    for (std::size_t k = 0; k < columns_.size(); ++k) group.chunks.push_back(write_chunk(k));
    written_rows_ += rows_.size();
    rows_.clear();
}

// One column of one row group: a page's header and the page.
ParquetWriter::Chunk ParquetWriter::write_chunk(std::size_t column) {
    std::string page = definition_levels(rows_, column);
    for (const auto& row : rows_) {
        if (!is_null(row[column])) append_value(page, columns_[column], row[column]);
    }
    std::string head;
    ThriftWriter header(head);
    header.i32(1, data_page);
    header.i32(2, static_cast<std::int32_t>(page.size()));
    header.i32(3, static_cast<std::int32_t>(page.size()));
    header.structure(5);
    ThriftWriter inner(head);
    inner.i32(1, static_cast<std::int32_t>(rows_.size()));
    inner.i32(2, plain);
    inner.i32(3, rle);
    inner.i32(4, rle);
    inner.end();
    header.end();
    const std::size_t offset = written_bytes_;
    write(head);
    write(page);
    return {offset, written_bytes_ - offset};
}

void ParquetWriter::append_group(std::string& footer, const Group& group) const {
    ThriftWriter writer(footer);
    writer.list(1, ThriftType::structure, columns_.size());
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const Chunk& chunk = group.chunks[k];
        bytes += chunk.bytes;
        ThriftWriter outer(footer);
        outer.i64(2, static_cast<std::int64_t>(chunk.offset));
        outer.structure(3);
        ThriftWriter about(footer);
        about.i32(1, type_number(columns_[k].type));
        about.list(2, ThriftType::i32, 2);
        about.plain_i32(plain);
        about.plain_i32(rle);
        about.list(3, ThriftType::binary, 1);
        about.plain_text(columns_[k].name);
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

void ParquetWriter::finish() {
    write_group();
    std::string footer;
    ThriftWriter about(footer);
    about.i32(1, 1);
    about.list(2, ThriftType::structure, columns_.size() + 1);
    append_schema(footer, columns_);
    about.i64(3, static_cast<std::int64_t>(written_rows_));
    about.list(4, ThriftType::structure, groups_.size());
    for (const Group& group : groups_) append_group(footer, group);
    about.text(6, "capstan");
    about.end();
    append(footer, static_cast<std::uint32_t>(footer.size()));
    write(footer);
    write(magic);
}

}  // namespace capstan::reports
