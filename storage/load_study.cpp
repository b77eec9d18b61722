// The description of a study, read back.
#include <charconv>
#include <string>

#include "capstan/storage/error.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"

namespace capstan::storage {
namespace {

template <class Record>
std::vector<Record> read_plain(Database& database, const std::string& table,
                               const std::string& owner_and_order, std::int64_t owner_id) {
    Statement select(database,
                     "SELECT " + column_names<Record>() + " FROM " + table + " WHERE " + owner_and_order);
    select.bind(1, owner_id);
    std::vector<Record> records;
    while (select.step()) records.push_back(read_record<Record>(select));
    return records;
}

std::vector<SensorSetRecord> read_sensor_sets(Database& database, std::int64_t study_id) {
    Statement select(database, "SELECT nodes FROM sensor_set WHERE study_id = ?1 ORDER BY set_index");
    select.bind(1, study_id);
    std::vector<SensorSetRecord> sets;
    while (select.step()) sets.push_back({parse_node_list(select.get<std::string>(0))});
    return sets;
}

std::vector<LayoutRecord> read_layouts(Database& database, const StudyIds& ids) {
    Statement select(database, "SELECT sensor_set_id, " + column_names<LayoutRecord>() +
                                   " FROM layout WHERE study_id = ?1 ORDER BY layout_id");
    select.bind(1, ids.study_id);
    std::vector<LayoutRecord> layouts;
    while (select.step()) {
        layouts.push_back(read_record<LayoutRecord>(select, 1));
        layouts.back().set_index = index_of(ids.sensor_sets, select.get<std::int64_t>(0));
    }
    return layouts;
}

std::vector<WorkUnitRecord> read_work_units(Database& database, const StudyIds& ids) {
    Statement select(database,
                     "SELECT stage, scenario_id, noise_level_id FROM work_unit WHERE study_id = ?1 "
                     "ORDER BY unit_index");
    select.bind(1, ids.study_id);
    std::vector<WorkUnitRecord> units;
    while (select.step()) {
        units.push_back({select.get<std::string>(0), index_of(ids.scenarios, select.get<std::int64_t>(1)),
                         index_of(ids.noise_levels, select.get<std::int64_t>(2))});
    }
    return units;
}

}  // namespace

StudyDescription load_study(Database& database, std::int64_t study_id) {
    const StudyIds ids = load_study_ids(database, study_id);
    StudyDescription description;
    description.study = read_plain<StudyRecord>(database, "study", "study_id = ?1", study_id).front();
    description.study.study_id = study_id;
    description.cable_segments =
        read_plain<CableSegmentRecord>(database, "cable_segment", "study_id = ?1 ORDER BY segment", study_id);
    description.regimes =
        read_plain<RegimeRecord>(database, "regime", "study_id = ?1 ORDER BY regime", study_id);
    description.scenarios =
        read_plain<ScenarioRecord>(database, "scenario", "study_id = ?1 ORDER BY scenario_index", study_id);
    for (std::size_t i = 0; i < ids.scenarios.size(); ++i) {
        description.scenarios[i].nodes = read_plain<ScenarioNodeRecord>(
            database, "scenario_node", "scenario_id = ?1 ORDER BY node", ids.scenarios[i]);
    }
    description.noise_levels =
        read_plain<NoiseLevelRecord>(database, "noise_level", "study_id = ?1 ORDER BY noise_index", study_id);
    description.fusion_methods = read_plain<FusionMethodRecord>(
        database, "fusion_method", "study_id = ?1 ORDER BY method_index", study_id);
    description.sensor_sets = read_sensor_sets(database, study_id);
    description.layouts = read_layouts(database, ids);
    description.work_units = read_work_units(database, ids);
    description.world_candidates = read_plain<WorldCandidateRecord>(
        database, "world_candidate", "study_id = ?1 ORDER BY candidate_index", study_id);
    return description;
}

std::string node_list_text(const std::vector<int>& nodes) {
    std::string text = "[";
    for (const int node : nodes) {
        if (text.size() > 1) text += ',';
        text += std::to_string(node);
    }
    return text + "]";
}

std::vector<int> parse_node_list(std::string_view text) {
    std::vector<int> nodes;
    const char* const end = text.data() + text.size();
    for (const char* next = text.data(); next != end;) {
        if (*next == '[' || *next == ',' || *next == ']' || *next == ' ') {
            ++next;
            continue;
        }
        int node = 0;
        const auto [after, problem] = std::from_chars(next, end, node);
        if (problem != std::errc{}) throw Error("Not a list of nodes: " + std::string(text));
        nodes.push_back(node);
        next = after;
    }
    return nodes;
}

}  // namespace capstan::storage
