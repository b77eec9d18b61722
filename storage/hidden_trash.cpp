#include "capstan/storage/hidden_trash.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capstan/storage/statement.h"

namespace capstan::storage {

namespace {

constexpr std::string_view shown_studies =
    "study_id NOT IN (SELECT study_id FROM main.study_mark WHERE is_deleted = 1)";

// How the row of a table that has such a column finds its study.
constexpr std::pair<std::string_view, std::string_view> parents[] = {
    {"scenario_id", "scenario"}, {"recommendation_id", "recommendation"}, {"cell_id", "cell"}};

bool has_column(Database& database, const std::string& table, std::string_view column) {
    Statement select(database, "SELECT count(*) FROM pragma_table_info(?1) WHERE name = ?2");
    select.bind_all(std::string_view(table), column);
    return select.step() && select.get<int>(0) > 0;
}

// Nothing: the table holds no study's rows.
std::optional<std::string> shown_rows(Database& database, const std::string& table) {
    if (has_column(database, table, "study_id")) return std::string(shown_studies);
    for (const auto& [column, parent] : parents) {
        if (!has_column(database, table, column) || table == parent) continue;
        const auto of_parent = shown_rows(database, std::string(parent));
        return std::string(column) + " IN (SELECT " + std::string(column) + " FROM main." +
               std::string(parent) + " WHERE " + of_parent.value() + ")";
    }
    return std::nullopt;
}

struct Named {
    std::string type;
    std::string name;
    std::string sql;
};

std::vector<Named> tables_and_views(Database& database) {
    std::vector<Named> found;
    Statement select(
        database,
        "SELECT type, name, sql FROM main.sqlite_schema WHERE type IN ('table', 'view') AND name NOT "
        "LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY rowid");
    while (select.step())
        found.push_back({select.get<std::string>(0), select.get<std::string>(1), select.get<std::string>(2)});
    return found;
}

}  // namespace

// Views of the connection's own schema come before the file's tables and views. A view of the file sees the
// file's tables only, so each is made again beside them.
void hide_trash(Database& database) {
    Statement any(database, "SELECT count(*) FROM study_mark WHERE is_deleted = 1");
    if (!any.step() || any.get<int>(0) == 0) return;
    constexpr std::string_view of_file = "CREATE VIEW ";
    const std::string made_beside = "CREATE TEMP VIEW IF NOT EXISTS ";
    for (const Named& each : tables_and_views(database)) {
        if (each.type == "view") {
            database.execute(made_beside + each.sql.substr(of_file.size()), "hide the trash");
        } else if (const auto shown = shown_rows(database, each.name)) {
            database.execute(
                made_beside + each.name + " AS SELECT * FROM main." + each.name + " WHERE " + *shown,
                "hide the trash");
        }
    }
}

}  // namespace capstan::storage
