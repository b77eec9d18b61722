#include "capstan/logs/table_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "capstan/cable/invalid_input.h"

namespace capstan::logs {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// A reading that is infinite is not a reading.
double finite_or_missing(double number) {
    return std::isfinite(number) ? number : not_a_number;
}

}  // namespace

std::string UniqueNames::operator()(const std::string& name) {
    int& uses = uses_[name];
    if (++uses == 1) return name;
    for (;; ++uses) {
        const std::string other = fmt::format("{}.{}", name, uses);
        if (uses_.try_emplace(other, 1).second) return other;
    }
}

int TableWriter::add_table(const std::string& name) {
    if (log_.tables.size() >= LogLimits::columns)
        throw InvalidInput(
            {fmt::format("{}: has more than {} tables", log_.file.string(), LogLimits::columns)});
    if (name.size() > LogLimits::name_bytes)
        throw InvalidInput({fmt::format("{}: a table's name has more than {} bytes", log_.file.string(),
                                        LogLimits::name_bytes)});
    log_.tables.emplace_back().name = table_names_(name);
    column_names_.emplace_back();
    rows_.emplace_back();
    return static_cast<int>(log_.tables.size()) - 1;
}

int TableWriter::add_column(int table, const std::string& name, const std::string& unit) {
    LogTable& its_table = log_.tables[static_cast<std::size_t>(table)];
    if (name.size() > LogLimits::name_bytes || unit.size() > LogLimits::name_bytes)
        throw InvalidInput({fmt::format("{}: a column's name has more than {} bytes", log_.file.string(),
                                        LogLimits::name_bytes)});
    const std::string own_name = column_names_[static_cast<std::size_t>(table)](name);
    if (options_.wanted && !options_.wanted(its_table.name, own_name)) return -1;
    if (++columns_ > LogLimits::columns)
        throw InvalidInput({fmt::format("{}: has more than {} columns; name those that are wanted",
                                        log_.file.string(), LogLimits::columns)});
    count_numbers(its_table.rows);
    its_table.add_column(own_name, unit, log_.store);
    row(table).push_back(not_a_number);
    return static_cast<int>(its_table.columns.size()) - 1;
}

void TableWriter::finish_row(int table) {
    LogTable& its_table = log_.tables[static_cast<std::size_t>(table)];
    std::vector<double>& numbers = row(table);
    count_numbers(numbers.size());
    for (std::size_t column = 0; column < numbers.size(); ++column) {
        its_table.columns[column].values.append(finite_or_missing(numbers[column]));
        numbers[column] = not_a_number;
    }
    ++its_table.rows;
}

void TableWriter::fill_column(int table, int column, std::span<const double> numbers) {
    LogTable& its_table = log_.tables[static_cast<std::size_t>(table)];
    count_numbers(numbers.size());
    NumberSeries& values = its_table.columns[static_cast<std::size_t>(column)].values;
    for (const double number : numbers) values.append(finite_or_missing(number));
}

void TableWriter::set_rows(int table, std::size_t rows) {
    log_.tables[static_cast<std::size_t>(table)].rows = rows;
}

void TableWriter::count_numbers(std::size_t count) {
    numbers_ += count;
    if (numbers_ > LogLimits::numbers)
        throw InvalidInput({fmt::format("{}: has more than {} numbers; name the columns that are wanted",
                                        log_.file.string(), LogLimits::numbers)});
}

}  // namespace capstan::logs
