#include "capstan/storage/integrity/hashed_rows.h"

#include <algorithm>

#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::storage {
namespace {

// In the order of their names, since a migrated table has them in another order than a new one.
std::vector<std::string> column_names_of(const std::string& table) {
    static const std::map<std::string, std::vector<std::string>> columns = [] {
        Database database = Database::in_memory();
        database.execute(schema_text(), "create the tables");
        Statement select(database,
                         "SELECT s.name, c.name FROM sqlite_schema s JOIN pragma_table_info(s.name) c "
                         "WHERE s.type = 'table' ORDER BY 1, 2");
        std::map<std::string, std::vector<std::string>> found;
        while (select.step()) found[select.get<std::string>(0)].push_back(select.get<std::string>(1));
        return found;
    }();
    return columns.at(table);
}

std::int64_t first_of(const std::vector<std::int64_t>& ids) {
    return ids.empty() ? 0 : ids.front();
}

bool is_left_out(const std::string& table, const std::string& column) {
    return column == "study_id" || column == "diagnosis_id" || (table == "study" && column == "status") ||
           (table == "work_unit" && column == "done");
}

// Of the numbers in a column that a file gives; empty: they are not of that kind.
std::string origin_of(const std::string& column, const StudyIds& ids) {
    if (column == "scenario_id") return std::to_string(first_of(ids.scenarios));
    if (column == "noise_level_id") return std::to_string(first_of(ids.noise_levels));
    if (column == "sensor_set_id") return std::to_string(first_of(ids.sensor_sets));
    if (column == "cell_id" || column == "recommendation_id")
        return std::to_string(numbered_within_study(ids.study_id, 0));
    if (column == "layout_id")
        return "(SELECT min(layout_id) FROM layout WHERE study_id = " + std::to_string(ids.study_id) + ")";
    return {};
}

std::string equals(const std::string& column, std::int64_t value) {
    return column + " = " + std::to_string(value);
}

std::string between(const std::string& column, std::int64_t first, std::int64_t last) {
    return column + " BETWEEN " + std::to_string(first) + " AND " + std::to_string(last);
}

std::string all_numbers_of_study(const std::string& column, std::int64_t study_id) {
    return between(column, numbered_within_study(study_id, 0), numbered_within_study(study_id, 999'999'999));
}

}  // namespace

std::vector<HashedRows> description_rows(const StudyIds& ids) {
    const std::string own = equals("study_id", ids.study_id);
    std::vector<HashedRows> tables = {{"study", own, "1"},
                                      {"cable_segment", own, "segment"},
                                      {"regime", own, "regime"},
                                      {"scenario", own, "scenario_index"},
                                      {"noise_level", own, "noise_index"},
                                      {"fusion_method", own, "method"},
                                      {"sensor_set", own, "set_index"},
                                      {"layout", own, "label"},
                                      {"work_unit", own, "unit_index"}};
    if (!ids.scenarios.empty())
        tables.push_back({"scenario_node",
                          between("scenario_id", ids.scenarios.front(), ids.scenarios.back()),
                          "scenario_id, node"});
    return tables;
}

HashedRows candidate_rows(std::int64_t study_id) {
    return {"world_candidate", equals("study_id", study_id), "candidate_index"};
}

std::vector<HashedRows> unit_rows(Database& database, const StudyIds& ids, int unit_index) {
    Statement select(database,
                     "SELECT stage, scenario_id, noise_level_id FROM work_unit WHERE study_id = ?1 AND "
                     "unit_index = ?2");
    select.bind_all(ids.study_id, unit_index);
    if (!select.step()) return {};
    const auto scenario_id = select.get<std::int64_t>(1);
    const auto noise_level_id = select.get<std::int64_t>(2);
    const std::string own =
        equals("scenario_id", scenario_id) + " AND " + equals("noise_level_id", noise_level_id);
    if (select.get<std::string>(0) == "single_sensor")
        return {{"single_sensor", own, "knowledge, sensor_node"},
                {"single_sensor_node", own, "knowledge, sensor_node, node"}};
    if (ids.methods.empty() || ids.sensor_sets.empty()) return {};
    const std::int64_t first = cell_id(ids, index_of(ids.scenarios, scenario_id),
                                       index_of(ids.noise_levels, noise_level_id), 0, ids.methods.front());
    const auto cells = static_cast<std::int64_t>(ids.methods.size() * ids.sensor_sets.size());
    const std::string cell_range = between("cell_id", first, first + cells - 1);
    return {{"sensor_weight", own, "sensor_node"},
            {"cell", cell_range, "cell_id"},
            {"cell_node", cell_range, "cell_id, node"},
            {"cell_block", cell_range, "cell_id, block"},
            {"known_direction_bound", own, "sensor_set_id"}};
}

std::vector<HashedRows> conclusion_rows(std::int64_t study_id) {
    const std::string own = equals("study_id", study_id);
    const std::string of_recommendation = all_numbers_of_study("recommendation_id", study_id);
    return {{"layout_error", own, "regime, noise_level_id, family, sensor_count, method"},
            {"sensor_matrix", own, "regime, noise_level_id, knowledge, sensor_node, node"},
            {"recommendation", of_recommendation, "recommendation_id"},
            {"recommendation_count", of_recommendation, "recommendation_id, sensor_count"},
            {"recommendation_alternative", of_recommendation, "recommendation_id, sensor_set_id, method"},
            {"paper_comparison", own, "row_index"},
            {"world_recommendation", own, "study_id"}};
}

HashedRows hash_list_rows(std::int64_t study_id) {
    return {"content_hash", equals("study_id", study_id) + " AND part <> 'study'",
            "part, part_index, table_name"};
}

std::vector<HashedRows> diagnosis_rows(std::int64_t diagnosis_id) {
    const std::string own = equals("diagnosis_id", diagnosis_id);
    return {{"diagnosis", own, "1"},
            {"diagnosis_effect", own, "place"},
            {"diagnosis_cause", own, "cause_index"},
            {"diagnosis_number", own, "cause_index, name"},
            {"diagnosis_candidate", own, "candidate_index"},
            {"diagnosis_channel", own, "channel_index"},
            {"diagnosis_gap", own, "part_index"}};
}

std::string HashedColumns::selected() const {
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k)
        text += (k == 0 ? "" : ", ") + names[k] + (origins[k].empty() ? "" : " - " + origins[k]);
    return text;
}

HashedColumns hashed_columns(const std::string& table, const StudyIds& ids) {
    HashedColumns columns;
    for (const std::string& column : column_names_of(table)) {
        if (is_left_out(table, column)) continue;
        columns.names.push_back(column);
        columns.origins.push_back(origin_of(column, ids));
    }
    return columns;
}

std::map<std::string, std::string> digests_of(Database& database, const StudyIds& ids,
                                              const std::vector<HashedRows>& tables) {
    std::map<std::string, std::string> digests;
    RowDigest digest;
    for (const HashedRows& rows : tables) {
        const HashedColumns columns = hashed_columns(rows.table, ids);
        Statement select(database, "SELECT " + columns.selected() + " FROM " + rows.table + " WHERE " +
                                       rows.where + " ORDER BY " + rows.order);
        while (select.step("hash the rows of a table")) digest.add_row(select, columns.names);
        if (!digest.has_rows()) continue;
        digests[rows.table] = hexadecimal(digest.finish());
    }
    return digests;
}

}  // namespace capstan::storage
