#pragma once
// The digest of rows while they are written: the same as of the stored rows, without reading them back.

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capstan/storage/integrity/hashed_rows.h"

namespace capstan::storage {

/// For the rows of one table, written in the order in which they are hashed.
class WrittenRows {
  public:
    /// `columns` are those that each row gives values for, as "a, b, c".
    WrittenRows(const std::string& table, std::string_view columns, const StudyIds& ids) : table_(table) {
        const HashedColumns hashed = hashed_columns(table, ids);
        const std::vector<std::string> given = split(columns);
        for (std::size_t k = 0; k < hashed.names.size(); ++k) {
            const auto found = std::find(given.begin(), given.end(), hashed.names[k]);
            if (found == given.end()) continue;  // NULL, or what the table's default gives
            std::int64_t origin = 0;
            const std::string& text = hashed.origins[k];
            std::from_chars(text.data(), text.data() + text.size(), origin);
            columns_.push_back({hashed.names[k], static_cast<std::size_t>(found - given.begin()), origin});
        }
    }

    /// One row: the values in the order of `columns`.
    template <class... Values>
    void add(const Values&... values) {
        const Value row[] = {value_of(values)...};
        for (const Column& column : columns_) {
            const Value& value = row[column.position];
            if (const auto* integer = std::get_if<std::int64_t>(&value))
                digest_.add(column.name, *integer - column.origin);
            else if (const auto* number = std::get_if<double>(&value))
                digest_.add(column.name, *number);
            else if (const auto* text = std::get_if<std::string_view>(&value))
                digest_.add(column.name, *text);
        }
        digest_.end_row();
    }

    const std::string& table() const { return table_; }
    bool has_rows() const { return digest_.has_rows(); }
    std::string finish() { return hexadecimal(digest_.finish()); }

  private:
    using Value = std::variant<std::monostate, std::int64_t, double, std::string_view>;
    struct Column {
        std::string name;
        std::size_t position = 0;  // among the given values
        std::int64_t origin = 0;
    };

    static Value value_of(int value) { return std::int64_t{value}; }
    static Value value_of(std::int64_t value) { return value; }
    static Value value_of(std::uint64_t value) { return static_cast<std::int64_t>(value); }
    static Value value_of(double value) { return value; }
    static Value value_of(std::string_view value) { return value; }
    static Value value_of(const std::optional<double>& value) {
        return value ? Value(*value) : Value(std::monostate{});
    }

    static std::vector<std::string> split(std::string_view columns) {
        std::vector<std::string> names;
        while (!columns.empty()) {
            const std::size_t end = std::min(columns.find(", "), columns.size());
            names.emplace_back(columns.substr(0, end));
            columns.remove_prefix(std::min(end + 2, columns.size()));
        }
        return names;
    }

    std::string table_;
    std::vector<Column> columns_;
    RowDigest digest_;
};

}  // namespace capstan::storage
