#include "capstan/reports/table.h"

#include <algorithm>
#include <stdexcept>

#include "capstan/storage/error.h"

namespace capstan::reports {

namespace {

// No program writes it there, and the schema's types would not let it; but a disk may hold anything.
[[noreturn]] void refuse(std::string_view column, const char* wanted) {
    throw storage::Error("Column '" + std::string(column) + "' does not hold " + wanted +
                         ": the database is damaged. `capstan doctor` examines it; go back to a copy.");
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
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* number = std::get_if<double>(&value)) return *number;
    refuse(column, "a number");
}

std::int64_t Row::whole(std::string_view column) const {
    if (const auto* whole = std::get_if<std::int64_t>(&at(column))) return *whole;
    refuse(column, "a whole number");
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
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    return nullptr;
}

}  // namespace capstan::reports
