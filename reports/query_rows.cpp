#include "capstan/reports/query_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/platform/standard_streams.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::reports {

namespace {

using storage::QueryResult;
using storage::QueryValue;

bool is_number(const QueryValue& value) {
    return std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value);
}

// Line breaks would tear a table apart.
std::string on_one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return printable(text);
}

struct ForPeople {
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return fmt::format("{:.6g}", value); }
    std::string operator()(const std::string& value) const { return on_one_line(value); }
};

std::string without_trailing_blanks(std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

}  // namespace

Data data_of_cell(const QueryValue& value) {
    if (std::holds_alternative<std::monostate>(value)) return {};
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return *integer;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    return std::get<std::string>(value);
}

std::string rows_text(const QueryResult& result) {
    std::vector<std::size_t> width;
    std::vector<bool> numeric;
    for (std::size_t c = 0; c < result.columns.size(); ++c) {
        width.push_back(columns_of(result.columns[c]));
        numeric.push_back(!result.rows.empty());
        for (const auto& row : result.rows) {
            width[c] = std::max(width[c], columns_of(std::visit(ForPeople{}, row[c])));
            if (!is_number(row[c]) && !std::holds_alternative<std::monostate>(row[c])) numeric[c] = false;
        }
    }
    std::string head, rule, body;
    for (std::size_t c = 0; c < width.size(); ++c) {
        head += padded(result.columns[c], width[c], numeric[c]) + "  ";
        rule += std::string(width[c], '-') + "  ";
    }
    for (const auto& row : result.rows) {
        std::string line;
        for (std::size_t c = 0; c < width.size(); ++c) {
            line += padded(std::visit(ForPeople{}, row[c]), width[c], numeric[c]) + "  ";
        }
        body += without_trailing_blanks(std::move(line));
    }
    return without_trailing_blanks(std::move(head)) + without_trailing_blanks(std::move(rule)) + body;
}

std::string row_json(const std::vector<std::string>& columns, const std::vector<storage::QueryValue>& row) {
    Data object = Data::record();
    for (std::size_t c = 0; c < row.size(); ++c) object[columns[c]] = data_of_cell(row[c]);
    std::string text = json_text(object);
    text.pop_back();  // its line break
    std::string indented = "  ";
    for (const char letter : text) {
        indented += letter;
        if (letter == '\n') indented += "  ";
    }
    return indented;
}

std::string rows_json(const QueryResult& result) {
    if (result.rows.empty()) return "[]\n";
    std::string text = "[";
    for (const auto& row : result.rows)
        text += (text.size() == 1 ? "\n" : ",\n") + row_json(result.columns, row);
    return text + "\n]\n";
}

}  // namespace capstan::reports
