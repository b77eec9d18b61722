#include "capstan/storage/schema_documentation.h"

#include <sqlite3.h>

#include <map>
#include <memory>
#include <sstream>

#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::storage {
namespace {

struct Words {
    std::map<std::string, std::string> tables;
    std::map<std::string, std::string> columns;  // 'table.column'
};

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t,") + 1 - first);
}

std::string with(const std::string& before, const std::string& more) {
    return before.empty() || more.empty() ? before + more : before + " " + more;
}

// A comment belongs to the line it ends, or to the line after it.
Words words_of(const std::string& schema) {
    Words words;
    std::istringstream lines(schema);
    std::string line, table, above;
    bool in_view = false;
    while (std::getline(lines, line)) {
        const auto dashes = line.find("--");
        const std::string comment = dashes == std::string::npos ? "" : trimmed(line.substr(dashes + 2));
        const std::string code = trimmed(line.substr(0, dashes));
        const auto colon = comment.find(": ");
        if (code.empty() && in_view && colon != std::string::npos) {  // 'column: words'
            words.columns[table + "." + comment.substr(0, colon)] = comment.substr(colon + 2);
            continue;
        }
        if (code.empty()) {
            above = comment.empty() ? "" : with(above, comment);
            continue;
        }
        std::istringstream parts(code);
        std::string first, second, third;
        parts >> first >> second >> third;
        if (first == "CREATE" && (second == "TABLE" || second == "VIEW")) {
            table = third;
            in_view = second == "VIEW";
            words.tables[table] = with(above, comment);
        } else if (in_view || first.front() == ')' || second == "INDEX") {
            in_view = in_view && first.back() != ';' && code.back() != ';';
            if (!in_view) table.clear();
        } else if (!table.empty()) {
            words.columns[table + "." + first] = with(above, comment);
        }
        above.clear();
    }
    return words;
}

std::string unit_of(const std::string& column) {
    for (const char* unit : {"N", "m", "rad", "s"}) {
        if (column.ends_with(std::string("_") + unit)) return unit;
    }
    return column.ends_with("_in_unit") ? "unit" : "";
}

struct Closer {
    void operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Connection = std::unique_ptr<sqlite3, Closer>;

Connection empty_database() {
    sqlite3* raw = nullptr;
    const int code = sqlite3_open(":memory:", &raw);
    Connection connection(raw);
    if (code != SQLITE_OK || sqlite3_exec(raw, schema_text().c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
        throw Error("The schema does not make a database: please report this.");
    return connection;
}

std::vector<std::vector<std::string>> rows_of(sqlite3* connection, const std::string& sql) {
    sqlite3_stmt* raw = nullptr;
    sqlite3_prepare_v2(connection, sql.c_str(), -1, &raw, nullptr);
    const std::unique_ptr<sqlite3_stmt, Closer> statement(raw);
    std::vector<std::vector<std::string>> rows;
    while (sqlite3_step(raw) == SQLITE_ROW) {
        auto& row = rows.emplace_back();
        for (int k = 0; k < sqlite3_column_count(raw); ++k) {
            const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(raw, k));
            row.emplace_back(text ? text : "");
        }
    }
    return rows;
}

std::string in_table(const std::string& text) {  // a bar would end the cell
    std::string safe;
    for (const char letter : text) safe += letter == '|' ? "\\|" : std::string(1, letter);
    return safe;
}

}  // namespace

std::vector<DocumentedTable> schema_documentation() {
    const Words words = words_of(schema_text());
    const Connection connection = empty_database();
    std::map<std::string, std::string> by_name;  // what a column of that name meant first
    std::vector<DocumentedTable> tables;
    for (const auto& entry : rows_of(connection.get(),
                                     "SELECT name, type FROM sqlite_schema WHERE type IN "
                                     "('table', 'view') ORDER BY rowid")) {
        DocumentedTable table{entry[0], entry[1] == "view", words.tables.at(entry[0]), {}};
        for (const auto& row :
             rows_of(connection.get(),
                     "SELECT name, type, pk, \"notnull\" FROM pragma_table_info('" + table.name + "')")) {
            DocumentedColumn column{row[0], row[1], unit_of(row[0]), "", row[2] != "0", false};
            column.may_be_null = !table.is_view && !column.is_key && row[3] == "0";
            const auto own = words.columns.find(table.name + "." + column.name);
            if (own != words.columns.end()) column.meaning = own->second;
            if (column.meaning.empty()) column.meaning = by_name[column.name];
            by_name.emplace(column.name, column.meaning);
            if (by_name[column.name].empty()) by_name[column.name] = column.meaning;
            table.columns.push_back(std::move(column));
        }
        tables.push_back(std::move(table));
    }
    return tables;
}

std::string schema_markdown() {
    std::string text;
    for (const DocumentedTable& table : schema_documentation()) {
        text += "\n#### " + table.name + (table.is_view ? " (view)" : "") + "\n\n" + table.meaning +
                "\n\n| column | type | unit | meaning |\n| --- | --- | --- | --- |\n";
        for (const DocumentedColumn& column : table.columns) {
            text += "| `" + column.name + "` | " + (column.is_key ? "key, " : "") + column.type +
                    (column.may_be_null ? " or NULL" : "") + " | " + column.unit + " | " +
                    in_table(column.meaning) + " |\n";
        }
    }
    return text;
}

}  // namespace capstan::storage
