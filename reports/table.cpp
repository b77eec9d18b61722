#include "capstan/reports/table.h"

#include <algorithm>
#include <stdexcept>

#include "capstan/storage/error.h"
#include "capstan/storage/report_queries.h"

namespace capstan::reports {

namespace {

// The types of the schema exclude such a value, so the file has been damaged.
[[noreturn]] void refuse(std::string_view column, const char* wanted) {
    throw storage::Error("Column '" + std::string(column) + "' does not hold " + wanted +
                         ": the database is damaged. `capstan doctor` examines it; go back to a copy.");
}

std::vector<Table> read_tables(storage::Database& database, std::int64_t study_id) {
    std::vector<Table> tables;
    for (const storage::ReportQuery& query : storage::report_queries()) {
        storage::QueryResult result = storage::read_report_table(database, query, study_id);
        tables.push_back({std::string(query.table), std::string(query.meaning), std::move(result.columns),
                          std::move(result.rows)});
    }
    return tables;
}

}  // namespace

const Value& Row::at(std::string_view column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end())
        throw std::logic_error("No column '" + std::string(column) + "' in this table.");
    return values_[static_cast<std::size_t>(found - columns_.begin())];
}

std::string Row::text(std::string_view column) const {
    const Value& value = at(column);
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    const nlohmann::json json = to_json(value);
    return json.is_null() ? "" : json.dump();
}

double Row::number(std::string_view column) const {
    const Value& value = at(column);
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
    if (const auto* number = std::get_if<double>(&value)) return *number;
    refuse(column, "a number");
}

std::int64_t Row::integer(std::string_view column) const {
    if (const auto* integer = std::get_if<std::int64_t>(&at(column))) return *integer;
    refuse(column, "an integer");
}

std::optional<double> Row::maybe_number(std::string_view column) const {
    if (std::holds_alternative<std::monostate>(at(column))) return std::nullopt;
    return number(column);
}

std::vector<Row> Table::each() const {
    std::vector<Row> list;
    for (const auto& row : rows) list.emplace_back(columns, row);
    return list;
}

bool Table::has_column(std::string_view column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
}

const Table* Tables::find(std::string_view name) const {
    const auto found =
        std::find_if(tables_.begin(), tables_.end(), [&](const Table& table) { return table.name == name; });
    return found == tables_.end() ? nullptr : &*found;
}

const Table& Tables::operator[](std::string_view name) const {
    const Table* found = find(name);
    if (found == nullptr) throw std::logic_error("No report table '" + std::string(name) + "'.");
    return *found;
}

nlohmann::json to_json(const Value& value) {
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return *integer;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    return nullptr;
}

StudyTables::StudyTables(storage::Database& database, std::int64_t study_id)
    : Tables(read_tables(database, study_id)) {
    if ((*this)["study"].empty()) {
        throw storage::Error("There is no study " + std::to_string(study_id) + " in " +
                             database.path().string() +
                             ", so there is nothing to report. `capstan study list` shows the studies.");
    }
}

}  // namespace capstan::reports
