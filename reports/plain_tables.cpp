#include "capstan/reports/plain_tables.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace capstan::reports {
namespace {

// RFC 4180: quotes around text that holds a comma, a quote or a line break.
std::string csv_field(const Value& value) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr) {
        const nlohmann::json json = to_json(value);
        return json.is_null() ? "" : json.dump();
    }
    if (text->find_first_of(",\"\r\n") == std::string::npos) return *text;
    std::string quoted = "\"";
    for (const char letter : *text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
    return quoted + '"';
}

}  // namespace

std::string table_csv(const Table& table) {
    std::string text = fmt::format("{}\r\n", fmt::join(table.columns, ","));
    for (const auto& row : table.rows) {
        std::vector<std::string> fields;
        for (const Value& value : row) fields.push_back(csv_field(value));
        text += fmt::format("{}\r\n", fmt::join(fields, ","));
    }
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

std::string markdown_of(const NumberTable& numbers) {
    std::string text = fmt::format("\n## {}\n\n|", numbers.caption);
    for (const std::string& head : numbers.heads) text += fmt::format(" {} |", head);
    text += "\n|";
    for (std::size_t k = 0; k < numbers.heads.size(); ++k) text += " --- |";
    for (const auto& row : numbers.rows) {
        text += "\n|";
        for (const std::string& cell : row) text += fmt::format(" {} |", escape_markdown(cell));
    }
    return text + "\n";
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
