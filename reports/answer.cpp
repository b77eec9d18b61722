// The formats of an answer other than the page.
#include "capstan/reports/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "capstan/platform/wrapped_text.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/reports/query_rows.h"

namespace capstan::reports {
namespace {

constexpr std::size_t text_width = 100;
constexpr std::string_view breakable = "wrap";  // the format of a column of long texts

std::string number_text(double value, const std::string& format) {
    if (!std::isfinite(value)) return "-";
    if (format.empty()) return fmt::format("{:.4g}", value);
    if (format.ends_with('%'))
        return fmt::format(fmt::runtime("{:" + format.substr(0, format.size() - 1) + "f} %"), 100.0 * value);
    return fmt::format(fmt::runtime("{:" + format + "}"), value);
}

std::string cell_text(const Data& value, const Column& column) {
    if (const std::string* text = value.text())
        return text->empty() ? "-" : column.words != nullptr ? column.words(*text) : *text;
    if (const double* number = value.number()) return number_text(*number, column.format);
    if (const std::int64_t* integer = value.integer()) return std::to_string(*integer);
    if (const bool* boolean = value.boolean()) return *boolean ? "yes" : "no";
    const std::vector<Data>& items = value.items();
    const bool is_interval = items.size() == 2 && items[0].number() != nullptr;
    std::string text;
    for (const Data& item : items)
        text += (text.empty() ? "" : is_interval ? " to " : ", ") + cell_text(item, column);
    return text.empty() ? "-" : text;
}

bool is_numeric(const AnswerTable& table, const Column& column) {
    return std::none_of(table.rows.items().begin(), table.rows.items().end(), [&](const Data& row) {
        const Data* value = row.find(column.path);
        return value != nullptr && value->text() != nullptr;
    });
}

// Too wide for a terminal: each row as its short cells, and its long texts below.
std::string records_text(const AnswerTable& table, const std::vector<std::vector<std::string>>& cells) {
    constexpr std::string_view indent = "      ";
    std::string text;
    for (std::size_t row = 1; row < cells.size(); ++row) {
        std::string head = " ", below;
        for (std::size_t c = 0; c < cells[row].size(); ++c) {
            const std::string& cell = cells[row][c];
            if (cell == "-") continue;
            if (table.columns[c].format != breakable) {
                head += " " + cell;
                continue;
            }
            std::string title = cells[0][c];
            title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
            below += (below.empty() ? "" : title + ": ") + cell + (cell.ends_with('.') ? " " : ". ");
        }
        text += head + "\n" + wrapped(below, text_width, indent, indent) + "\n";
    }
    return text;
}

std::string table_text(const AnswerTable& table) {
    const auto cells = cells_of(table);
    std::vector<std::size_t> widths(table.columns.size(), 0);
    for (const auto& row : cells)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], columns_of(row[c]));
    std::string text = table.caption.empty() ? "" : table.caption + "\n";
    std::size_t total = 1;
    bool is_breakable = false;
    for (std::size_t c = 0; c < widths.size(); ++c) {
        total += widths[c] + 2;
        is_breakable = is_breakable || table.columns[c].format == breakable;
    }
    if (is_breakable && total > text_width) return text + records_text(table, cells);
    for (const auto& row : cells) {
        std::string line = " ";
        for (std::size_t c = 0; c < row.size(); ++c)
            line += " " + padded(row[c], widths[c], is_numeric(table, table.columns[c])) + " ";
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string paragraph(const std::string& text) {
    return text.empty() ? "" : wrapped(text, text_width, "", "") + "\n";
}

// A value of a table in full precision, as CSV and programs read it.
std::string exact_text(const Data& value) {
    const std::string* text = value.text();
    return text != nullptr ? *text : value.is_nothing() ? "" : json_line(value);
}

}  // namespace

std::vector<std::vector<std::string>> cells_of(const AnswerTable& table) {
    std::vector<std::vector<std::string>> cells(1);
    for (const Column& column : table.columns)
        cells[0].push_back(column.title + (column.unit.empty() ? "" : " [" + column.unit + "]"));
    for (const Data& row : table.rows.items()) {
        if (table.max_shown > 0 && cells.size() > table.max_shown) break;
        auto& line = cells.emplace_back();
        for (const Column& column : table.columns) {
            const Data* value = row.find(column.path);
            line.push_back(value == nullptr ? "-" : cell_text(*value, column));
        }
    }
    return cells;
}

std::string answer_text(const Answer& answer) {
    std::string text = paragraph(answer.title + ": " + answer.headline);
    for (const AnswerSection& section : answer.sections) {
        if (section.prose.empty() && section.tables.empty() && section.note.empty())
            continue;  // figures only
        text += "\n" + (section.heading.empty() ? "" : section.heading + "\n");
        text += paragraph(section.prose);
        for (const AnswerTable& table : section.tables) text += "\n" + table_text(table);
        if (!section.note.empty()) text += "\n" + paragraph(section.note);
    }
    return text;
}

std::string answer_json(const Answer& answer) {
    return json_text(answer.values);
}

std::string answer_csv(const Answer& answer) {
    for (const Table& table : answer.drawn) {
        if (table.name == answer.csv_table) return csv_text(table.columns, table.rows);
    }
    Table csv{answer.id, answer.title, {"table", "row", "column", "value", "unit"}, {}};
    for (const AnswerSection& section : answer.sections) {
        for (const AnswerTable& table : section.tables) {
            std::int64_t number = 0;
            for (const Data& row : table.rows.items()) {
                ++number;
                for (const Column& column : table.columns) {
                    const Data* value = row.find(column.path);
                    csv.rows.push_back({table.id, number, column.path,
                                        value == nullptr ? std::string() : exact_text(*value), column.unit});
                }
            }
        }
    }
    return csv_text(csv.columns, csv.rows);
}

std::string answer_markdown(const Answer& answer) {
    std::string text =
        fmt::format("# {}\n\n{}\n", escape_markdown(answer.title), escape_markdown(answer.headline));
    for (const AnswerSection& section : answer.sections) {
        if (section.prose.empty() && section.tables.empty() && section.note.empty()) continue;
        if (!section.heading.empty()) text += fmt::format("\n## {}\n", escape_markdown(section.heading));
        if (!section.prose.empty()) text += fmt::format("\n{}\n", escape_markdown(section.prose));
        for (const AnswerTable& table : section.tables) text += markdown_of(table.caption, cells_of(table));
        if (!section.note.empty()) text += fmt::format("\n{}\n", escape_markdown(section.note));
    }
    return text;
}

std::string answer_in(const Answer& answer, AnswerFormat format) {
    switch (format) {
        case AnswerFormat::text:
            return answer_text(answer);
        case AnswerFormat::json:
            return answer_json(answer);
        case AnswerFormat::csv:
            return answer_csv(answer);
        case AnswerFormat::markdown:
            return answer_markdown(answer);
        case AnswerFormat::html:
            return answer_html(answer);
    }
    return {};
}

Data data_of(const Table& table) {
    Data rows = Data::list();
    for (const auto& row : table.rows) {
        Data record = Data::record();
        for (std::size_t k = 0; k < row.size(); ++k) record[table.columns[k]] = data_of_cell(row[k]);
        rows.push_back(std::move(record));
    }
    return rows;
}

std::size_t drawn_every(std::size_t samples, std::size_t limit) {
    return samples <= limit ? 1 : (samples + limit - 1) / limit;
}

}  // namespace capstan::reports
