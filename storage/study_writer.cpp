// The results of one work unit, and the mark that it is done, in one transaction.
#include <algorithm>
#include <string>

#include "capstan/storage/error.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {

struct CellBlockRow {
    int block = 0;
    double mean_abs_error_N = 0;
};

template <>
inline constexpr auto columns<CellBlockRow> = std::tuple{
    Column{"block", &CellBlockRow::block},
    Column{"mean_abs_error_N", &CellBlockRow::mean_abs_error_N},
};

namespace {

struct UnitAddress {
    std::int64_t study_id = 0;
    int unit_index = 0;
    const char* stage = "";
    std::int64_t scenario_id = 0;
    std::int64_t noise_level_id = 0;
};

[[noreturn]] void explain_refusal(Database& database, const UnitAddress& unit) {
    const std::string name =
        "Work unit " + std::to_string(unit.unit_index) + " of study " + std::to_string(unit.study_id);
    Statement select(database, "SELECT done FROM work_unit WHERE study_id = ?1 AND unit_index = ?2");
    select.bind_all(unit.study_id, unit.unit_index);
    if (!select.step()) throw Error(name + " does not exist in " + database.path().string() + ".");
    if (select.get<int>(0) == 1) {
        throw Error(name +
                    " is done already; its results stay. Is another program working on the same study?");
    }
    throw Error(name + " is not the stage, scenario and noise level of these results.");
}

// First, so that a unit that may not be written costs nothing.
void mark_done(Database& database, const UnitAddress& unit) {
    Statement update(database,
                     "UPDATE work_unit SET done = 1 WHERE study_id = ? AND unit_index = ? AND stage = ? "
                     "AND scenario_id = ? AND noise_level_id = ? AND done = 0");
    update.bind_all(unit.study_id, unit.unit_index, unit.stage, unit.scenario_id, unit.noise_level_id);
    update.run("mark a work unit as done");
    if (sqlite3_changes(database.connection()) == 0) explain_refusal(database, unit);
}

template <class Record, class Key>
bool rises(const std::vector<Record>& records, const Key& key) {
    return std::is_sorted(records.begin(), records.end(),
                          [&](const Record& a, const Record& b) { return key(a) < key(b); });
}

template <class Record>
bool nodes_rise(const std::vector<Record>& records) {
    return std::all_of(records.begin(), records.end(), [](const Record& record) {
        return rises(record.nodes, [](const auto& node) { return node.node; });
    });
}

// Whether the rows are written in the order in which they are hashed.
bool is_in_order(const SingleSensorResult& result) {
    return nodes_rise(result.sensors) && rises(result.sensors, [](const SingleSensorRecord& sensor) {
               return std::pair(std::string_view(sensor.knowledge), sensor.sensor_node);
           });
}

bool is_in_order(const FusionResult& result, const StudyIds& ids) {
    const auto number = [&](const CellRecord& cell) {
        return cell_id(ids, result.scenario_index, result.noise_index, cell.set_index, cell.method);
    };
    return nodes_rise(result.cells) && rises(result.cells, number) &&
           rises(result.weights, [](const SensorWeightRecord& weight) { return weight.sensor_node; }) &&
           rises(result.bounds, [](const KnownDirectionBoundRecord& bound) { return bound.set_index; });
}

// The hashes of what the writers wrote; read back where that was in another order.
template <class... Writers>
void hash_written(Database& database, const StudyIds& ids, int unit_index, bool is_in_order,
                  Writers&... writers) {
    if (is_in_order)
        hash_unit(database, ids, unit_index, {writers.written()...});
    else
        hash_unit(database, ids, unit_index);
}

template <class... Writers>
void begin_hashing(Database& database, const StudyIds& ids, Writers&... writers) {
    if (is_hashed(database, ids.study_id)) (writers.hash(ids), ...);
}

struct CellWriters {
    CellWriters(Database& database, const StudyIds& ids)
        : cells(database, "cell", "cell_id, scenario_id, noise_level_id, sensor_set_id"),
          nodes(database, "cell_node", "cell_id"),
          blocks(database, "cell_block", "cell_id") {
        begin_hashing(database, ids, cells, nodes, blocks);
    }

    RowWriter<CellRecord> cells;
    RowWriter<CellNodeRecord> nodes;
    RowWriter<CellBlockRow> blocks;
};

void write_cells(CellWriters& writers, const StudyIds& ids, const FusionResult& result,
                 const UnitAddress& unit) {
    std::vector<CellBlockRow> blocks;
    for (const CellRecord& cell : result.cells) {
        const std::int64_t set_id = id_at(ids.sensor_sets, cell.set_index, "sensor set");
        const std::int64_t id =
            cell_id(ids, result.scenario_index, result.noise_index, cell.set_index, cell.method);
        writers.cells.write(cell, id, unit.scenario_id, unit.noise_level_id, set_id);
        writers.nodes.write_all(cell.nodes, id);
        blocks.clear();
        for (const double mean_abs_error_N : cell.block_mean_abs_error_N) {
            blocks.push_back({static_cast<int>(blocks.size()), mean_abs_error_N});
        }
        writers.blocks.write_all(blocks, id);
    }
}

}  // namespace

void write_single_sensor(Database& database, std::int64_t study_id, int unit_index,
                         const SingleSensorResult& result) {
    Transaction transaction(database);
    const StudyIds ids = load_study_ids(database, study_id);
    const UnitAddress unit{study_id, unit_index, "single_sensor",
                           id_at(ids.scenarios, result.scenario_index, "scenario"),
                           id_at(ids.noise_levels, result.noise_index, "noise level")};
    mark_done(database, unit);
    RowWriter<SingleSensorRecord> rows(database, "single_sensor", "scenario_id, noise_level_id");
    RowWriter<SingleSensorNodeRecord> node_rows(database, "single_sensor_node",
                                                "scenario_id, noise_level_id, knowledge, sensor_node");
    begin_hashing(database, ids, rows, node_rows);
    for (const SingleSensorRecord& sensor : result.sensors) {
        rows.write(sensor, unit.scenario_id, unit.noise_level_id);
        node_rows.write_all(sensor.nodes, unit.scenario_id, unit.noise_level_id, sensor.knowledge,
                            sensor.sensor_node);
    }
    hash_written(database, ids, unit_index, is_in_order(result), rows, node_rows);
    transaction.commit();
}

void write_fusion(Database& database, std::int64_t study_id, int unit_index, const FusionResult& result) {
    Transaction transaction(database);
    const StudyIds ids = load_study_ids(database, study_id);
    const UnitAddress unit{study_id, unit_index, "fusion",
                           id_at(ids.scenarios, result.scenario_index, "scenario"),
                           id_at(ids.noise_levels, result.noise_index, "noise level")};
    mark_done(database, unit);
    RowWriter<SensorWeightRecord> weight_rows(database, "sensor_weight", "scenario_id, noise_level_id");
    begin_hashing(database, ids, weight_rows);
    weight_rows.write_all(result.weights, unit.scenario_id, unit.noise_level_id);
    CellWriters cells(database, ids);
    write_cells(cells, ids, result, unit);
    RowWriter<KnownDirectionBoundRecord> bound_rows(database, "known_direction_bound",
                                                    "scenario_id, noise_level_id, sensor_set_id");
    begin_hashing(database, ids, bound_rows);
    for (const KnownDirectionBoundRecord& bound : result.bounds) {
        bound_rows.write(bound, unit.scenario_id, unit.noise_level_id,
                         id_at(ids.sensor_sets, bound.set_index, "sensor set"));
    }
    hash_written(database, ids, unit_index, is_in_order(result, ids), weight_rows, cells.cells, cells.nodes,
                 cells.blocks, bound_rows);
    transaction.commit();
}

}  // namespace capstan::storage
