#pragma once
// Tables of a page: rows read by column name.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/read_only_query.h"

namespace capstan::reports {

using Value = storage::QueryValue;

// One row, read by column name. A value that is not of the expected type is a storage::Error: the file is
// damaged.
class Row {
  public:
    Row(const std::vector<std::string>& columns, const std::vector<Value>& values)
        : columns_(columns), values_(values) {}

    const Value& at(std::string_view column) const;
    std::string text(std::string_view column) const;
    double number(std::string_view column) const;
    std::int64_t integer(std::string_view column) const;
    std::optional<double> maybe_number(std::string_view column) const;

  private:
    const std::vector<std::string>& columns_;
    const std::vector<Value>& values_;
};

struct Table {
    std::string name;
    std::string meaning;
    std::vector<std::string> columns;
    std::vector<std::vector<Value>> rows;

    bool empty() const { return rows.empty(); }
    std::vector<Row> each() const;
    bool has_column(std::string_view column) const;
};

// All tables of one page.
class Tables {
  public:
    explicit Tables(std::vector<Table> tables) : tables_(std::move(tables)) {}

    const std::vector<Table>& all() const { return tables_; }
    const Table* find(std::string_view name) const;
    const Table& operator[](std::string_view name) const;  // which must be there

  private:
    std::vector<Table> tables_;
};

// The same value wherever it is shown, in full precision: numbers read back to the same bits.
nlohmann::json to_json(const Value& value);

// All tables of one study, read at once.
class StudyTables : public Tables {
  public:
    StudyTables(storage::Database& database, std::int64_t study_id);

    Row study() const { return (*this)["study"].each().front(); }
};

}  // namespace capstan::reports
