#include "capstan/reports/plain_tables.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace capstan::reports {
namespace {

struct CsvField {
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return fmt::format("{}", value); }
    std::string operator()(const std::string& text) const {
        if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
        std::string quoted = "\"";
        for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
        return quoted + '"';
    }
};

}  // namespace

std::string csv_head(const std::vector<std::string>& columns) {
    return csv_line({columns.begin(), columns.end()});
}

std::string csv_line(const std::vector<Value>& row) {
    std::string text;
    for (std::size_t k = 0; k < row.size(); ++k) text += (k == 0 ? "" : ",") + std::visit(CsvField{}, row[k]);
    return text + "\n";
}

std::string csv_text(const std::vector<std::string>& columns, const std::vector<std::vector<Value>>& rows) {
    std::string text = csv_head(columns);
    for (const auto& row : rows) text += csv_line(row);
    return text;
}

std::string tables_json(const std::vector<Table>& tables) {
    nlohmann::ordered_json report;
    for (const Table& table : tables) {
        auto& rows = report[table.name] = nlohmann::ordered_json::array();
        for (const auto& row : table.rows) {
            nlohmann::ordered_json record;
            for (std::size_t k = 0; k < row.size(); ++k) record[table.columns[k]] = to_json(row[k]);
            rows.push_back(std::move(record));
        }
    }
    return report.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string markdown_of(const std::string& heading, const std::vector<std::vector<std::string>>& cells) {
    std::string text = heading.empty() ? "\n" : fmt::format("\n### {}\n\n", heading);
    for (std::size_t row = 0; row < cells.size(); ++row) {
        text += "|";
        for (const std::string& cell : cells[row]) text += fmt::format(" {} |", escape_markdown(cell));
        text += "\n";
        if (row > 0) continue;
        text += "|";
        for (std::size_t k = 0; k < cells[row].size(); ++k) text += " --- |";
        text += "\n";
    }
    return text;
}

std::string escape_markdown(const std::string& text) {
    std::string safe;
    for (const char letter : text) {
        if (letter == '\n' || letter == '\r') {
            safe += ' ';
        } else if (letter == '<') {
            safe += "&lt;";
        } else {
            if (letter == '|' || letter == '\\' || letter == '*' || letter == '`' || letter == '[')
                safe += '\\';
            safe += letter;
        }
    }
    return safe;
}

}  // namespace capstan::reports
