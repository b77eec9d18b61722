#pragma once
// One record in, one row out, and back; generic over the record.

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "capstan/storage/integrity/written_rows.h"
#include "capstan/storage/record_columns.h"
#include "capstan/storage/statement.h"

namespace capstan::storage {

/// "name, seed, ..." as SQL lists them.
template <class Record>
std::string column_names() {
    std::string names;
    std::apply(
        [&](const auto&... column) { ((names += names.empty() ? "" : ", ", names += column.name), ...); },
        columns<Record>);
    return names;
}

/// References to the members that the columns stand for, in their order.
template <class Record>
auto fields_of(Record& record) {
    return std::apply([&](const auto&... column) { return std::tie(record.*column.member...); },
                      columns<std::remove_const_t<Record>>);
}

// Inserts records into one table: key columns first, then the record's own. Prepared once, used for many
// rows.
template <class Record>
class RowWriter {
  public:
    RowWriter(Database& database, const std::string& table, const std::string& key_columns)
        : table_(table),
          columns_(key_columns + ", " + column_names<Record>()),
          doing_("write into " + table),
          insert_one_(database, insert_text(table, key_columns, 1)),
          insert_batch_(database, insert_text(table, key_columns, batch)) {}

    /// Hashes all rows that are written from now on.
    void hash(const StudyIds& ids) { written_.emplace(table_, columns_, ids); }
    /// Null: nothing is hashed.
    WrittenRows* written() { return written_ ? &*written_ : nullptr; }

    template <class... Keys>
    void write(const Record& record, const Keys&... keys) {
        bind_row(insert_one_, 0, record, keys...);
        hash_row(record, keys...);
        insert_one_.run(doing_);
    }

    // Rows with the same keys. A statement costs about as much as two of its rows, so it takes several.
    template <class... Keys>
    void write_all(const std::vector<Record>& records, const Keys&... keys) {
        std::size_t next = 0;
        for (; next + batch <= records.size(); next += batch) {
            int bound = 0;
            for (std::size_t i = 0; i < batch; ++i) {
                bound = bind_row(insert_batch_, bound, records[next + i], keys...);
                hash_row(records[next + i], keys...);
            }
            insert_batch_.run(doing_);
        }
        for (; next < records.size(); ++next) write(records[next], keys...);
    }

  private:
    static constexpr std::size_t batch = 10;

    // Returns how many positions are bound by now.
    template <class... Keys>
    static int bind_row(Statement& insert, int bound, const Record& record, const Keys&... keys) {
        std::apply([&](const auto&... fields) { (insert.bind(++bound, fields), ...); },
                   std::tuple_cat(std::tie(keys...), fields_of(record)));
        return bound;
    }

    template <class... Keys>
    void hash_row(const Record& record, const Keys&... keys) {
        if (!written_) return;
        std::apply([&](const auto&... fields) { written_->add(keys..., fields...); }, fields_of(record));
    }

    static std::string insert_text(const std::string& table, const std::string& key_columns,
                                   std::size_t rows) {
        const std::string columns = key_columns + ", " + column_names<Record>();
        std::string marks = "(?";
        for (auto more = std::count(columns.begin(), columns.end(), ','); more > 0; --more) marks += ", ?";
        marks += ")";
        std::string text = "INSERT INTO " + table + " (" + columns + ") VALUES " + marks;
        for (std::size_t row = 1; row < rows; ++row) text += ", " + marks;
        return text;
    }

    std::string table_;
    std::string columns_;
    std::string doing_;
    std::optional<WrittenRows> written_;
    Statement insert_one_;
    Statement insert_batch_;
};

// The record that stands in the statement's current row from first_column on.
template <class Record>
Record read_record(const Statement& statement, int first_column = 0) {
    Record record;
    int column = first_column;
    std::apply(
        [&](auto&... fields) {
            ((fields = statement.get<std::remove_reference_t<decltype(fields)>>(column++)), ...);
        },
        fields_of(record));
    return record;
}

}  // namespace capstan::storage
