#include "capstan/recording/csv_numbers.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "capstan/platform/parsed_number.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/recording/json_object.h"

namespace capstan {

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // of UTF-8, as spreadsheets write it

constexpr double largest_reading = 1e12;  // a counter has less; loggers write 1e30 and more for "none"

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    while (true) {
        const std::size_t comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

// The numbers of one line; false, with the reason noted, if it does not hold one per column.
bool numbers_of(std::string_view line, const CsvNumbers& table, const std::string& place,
                ProblemList& problems, std::vector<double>& numbers) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() != table.columns.size()) {
        problems.add_line("columns", place,
                          fmt::format("{} for {}; is the line cut short?", counted(fields.size(), "value"),
                                      counted(table.columns.size(), "column")));
        return false;
    }
    numbers.clear();
    for (std::size_t column = 0; column < fields.size(); ++column) {
        const std::string_view field = fields[column];
        const double number = parsed_number<double>(field).value_or(std::nan(""));
        if (!std::isfinite(number)) {
            problems.add_line("number " + table.columns[column], place,
                              fmt::format("column '{}' has '{}', not a finite number; leave incomplete "
                                          "samples out, do not fill them",
                                          table.columns[column], field));
            return false;
        }
        if (std::abs(number) > largest_reading) {
            problems.add_line(
                "reading " + table.columns[column], place,
                fmt::format("column '{}' has {}, which no sensor reads in SI units; leave samples "
                            "without a reading out",
                            table.columns[column], field));
            return false;
        }
        numbers.push_back(number);
    }
    return true;
}

}  // namespace

CsvNumbers read_csv_numbers(const std::filesystem::path& path, ProblemList& problems) {
    const std::string text = read_input_file(path);
    CsvNumbers table;
    std::vector<double> numbers;
    std::string_view rest = text;
    if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
    for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
        const std::size_t end = rest.find('\n');
        const std::string_view line = trimmed(rest.substr(0, end));
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        const std::string place = fmt::format("{}:{}", path.string(), line_number);
        if (line_number == 1) {
            for (const std::string_view name : fields_of(line)) table.columns.emplace_back(name);
            table.values.resize(table.columns.size());
        } else if (line.empty()) {
            if (!rest.empty()) problems.add_line("empty", place, "the line is empty");
        } else if (numbers_of(line, table, place, problems, numbers)) {
            for (std::size_t column = 0; column < numbers.size(); ++column)
                table.values[column].push_back(numbers[column]);
        }
    }
    if (table.rows() == 0)
        problems.add(path.string(), "no samples; a header line and one line for each sample are needed");
    return table;
}

}  // namespace capstan
