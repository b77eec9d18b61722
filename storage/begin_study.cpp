// The description of a study, written.
#include <algorithm>
#include <string>

#include "capstan/storage/error.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

std::int64_t next_id(Database& database, const std::string& table, const std::string& id_column) {
    Statement statement(database, "SELECT coalesce(max(" + id_column + "), 0) + 1 FROM " + table);
    statement.step();
    return statement.get<std::int64_t>(0);
}

std::int64_t write_study(Database& database, const StudyRecord& study) {
    const std::int64_t study_id = std::max(next_id(database, "study", "study_id"),
                                           next_id(database, "history", "study_id"));  // also of removed ones
    StudyRecord begun = study;
    begun.status = "running";
    RowWriter<StudyRecord>(database, "study", "study_id").write(begun, study_id);
    write_event(database, study_id, "begun");
    return study_id;
}

// Rows whose key is the study and a column of their own.
template <class Record>
void write_plain(Database& database, const std::string& table, const std::vector<Record>& records,
                 std::int64_t study_id) {
    RowWriter<Record>(database, table, "study_id").write_all(records, study_id);
}

// Rows whose position is a column, and whose id numbers on.
template <class Record>
std::vector<std::int64_t> write_indexed(Database& database, const std::string& table,
                                        const std::string& id_column, const std::string& index_column,
                                        const std::vector<Record>& records, std::int64_t study_id) {
    RowWriter<Record> rows(database, table, id_column + ", study_id, " + index_column);
    std::int64_t id = next_id(database, table, id_column);
    std::vector<std::int64_t> ids;
    for (const Record& record : records) {
        rows.write(record, id, study_id, static_cast<int>(ids.size()));
        ids.push_back(id++);
    }
    return ids;
}

void write_scenario_nodes(Database& database, const std::vector<ScenarioRecord>& scenarios,
                          const std::vector<std::int64_t>& scenario_ids) {
    RowWriter<ScenarioNodeRecord> rows(database, "scenario_node", "scenario_id");
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
        rows.write_all(scenarios[i].nodes, scenario_ids[i]);
    }
}

void write_fusion_methods(Database& database, const std::vector<FusionMethodRecord>& methods,
                          std::int64_t study_id) {
    RowWriter<FusionMethodRecord> rows(database, "fusion_method", "study_id, method_index");
    int method_index = 0;
    for (const FusionMethodRecord& method : methods) rows.write(method, study_id, method_index++);
}

std::vector<std::int64_t> write_sensor_sets(Database& database, const std::vector<SensorSetRecord>& sets,
                                            std::int64_t study_id) {
    Statement insert(database,
                     "INSERT INTO sensor_set (sensor_set_id, study_id, set_index, sensor_count, nodes) "
                     "VALUES (?, ?, ?, ?, ?)");
    std::int64_t id = next_id(database, "sensor_set", "sensor_set_id");
    std::vector<std::int64_t> ids;
    for (const SensorSetRecord& set : sets) {
        insert.bind_all(id, study_id, static_cast<int>(ids.size()), static_cast<int>(set.nodes.size()),
                        node_list_text(set.nodes));
        insert.run("write into sensor_set");
        ids.push_back(id++);
    }
    return ids;
}

void write_layouts(Database& database, const std::vector<LayoutRecord>& layouts, const StudyIds& ids) {
    RowWriter<LayoutRecord> rows(database, "layout", "layout_id, study_id, sensor_set_id");
    std::int64_t id = next_id(database, "layout", "layout_id");
    for (const LayoutRecord& layout : layouts) {
        rows.write(layout, id++, ids.study_id, id_at(ids.sensor_sets, layout.set_index, "sensor set"));
    }
}

void write_work_units(Database& database, const std::vector<WorkUnitRecord>& units, const StudyIds& ids) {
    Statement insert(database,
                     "INSERT INTO work_unit (study_id, unit_index, stage, scenario_id, noise_level_id, done) "
                     "VALUES (?, ?, ?, ?, ?, 0)");
    int unit_index = 0;
    for (const WorkUnitRecord& unit : units) {
        insert.bind_all(ids.study_id, unit_index++, unit.stage,
                        id_at(ids.scenarios, unit.scenario_index, "scenario"),
                        id_at(ids.noise_levels, unit.noise_index, "noise level"));
        insert.run("write into work_unit");
    }
}

void write_world_candidates(Database& database, const std::vector<WorldCandidateRecord>& candidates,
                            std::int64_t study_id) {
    RowWriter<WorldCandidateRecord> rows(database, "world_candidate", "study_id, candidate_index");
    int candidate_index = 0;
    for (const WorldCandidateRecord& candidate : candidates)
        rows.write(candidate, study_id, candidate_index++);
}

std::int64_t write_description(Database& database, const StudyDescription& description) {
    StudyIds ids;
    ids.study_id = write_study(database, description.study);
    write_plain(database, "cable_segment", description.cable_segments, ids.study_id);
    write_world_candidates(database, description.world_candidates, ids.study_id);
    write_plain(database, "regime", description.regimes, ids.study_id);
    ids.scenarios = write_indexed(database, "scenario", "scenario_id", "scenario_index",
                                  description.scenarios, ids.study_id);
    write_scenario_nodes(database, description.scenarios, ids.scenarios);
    ids.noise_levels = write_indexed(database, "noise_level", "noise_level_id", "noise_index",
                                     description.noise_levels, ids.study_id);
    write_fusion_methods(database, description.fusion_methods, ids.study_id);
    ids.sensor_sets = write_sensor_sets(database, description.sensor_sets, ids.study_id);
    write_layouts(database, description.layouts, ids);
    write_work_units(database, description.work_units, ids);
    hash_description(database, ids);
    return ids.study_id;
}

}  // namespace

std::int64_t begin_study(Database& database, const StudyDescription& description) {
    Transaction transaction(database);
    const std::int64_t study_id = write_description(database, description);
    transaction.commit();
    return study_id;
}

std::optional<std::vector<std::int64_t>> begin_shard(Database& database, const ShardRecord& shard,
                                                     const std::vector<StudyDescription>& descriptions) {
    Transaction transaction(database);
    if (next_id(database, "study", "study_id") != 1) return std::nullopt;
    Statement insert(database, "INSERT INTO shard (shard, shards) VALUES (?, ?)");
    insert.bind_all(shard.shard, shard.shards);
    insert.run("mark the file as a shard");
    std::vector<std::int64_t> study_ids;
    for (const StudyDescription& description : descriptions)
        study_ids.push_back(write_description(database, description));
    transaction.commit();
    return study_ids;
}

std::string words_of(const ShardRecord& shard) {
    return "shard " + std::to_string(shard.shard) + " of " + std::to_string(shard.shards);
}

std::vector<std::int64_t> begin_or_find_shard(Database& database, const ShardRecord& shard,
                                              const std::vector<StudyDescription>& descriptions) {
    // A file without studies is begun, unless another program begins the same shard at this moment.
    if (const auto begun = begin_shard(database, shard, descriptions)) return *begun;
    const std::string file = database.path().string();
    const std::string try_this = " Name a new file, or remove this one.";
    const auto mark = read_shard(database);  // came with the studies, in one transaction
    if (!mark) throw Error(file + " holds complete studies, so no shard can be run in it." + try_this);
    if (*mark != shard)
        throw Error(file + " is " + words_of(*mark) + ", not " + words_of(shard) + "." + try_this);
    std::vector<std::int64_t> ids;
    for (const StudySummary& study : list_studies(database)) ids.push_back(study.study_id);
    return ids;
}

}  // namespace capstan::storage
