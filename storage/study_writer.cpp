// The results of one work unit, and the mark that it is done, in one transaction.
#include <string>

#include "capstan/storage/error.h"
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

void write_cells(Database& database, const StudyIds& ids, const FusionResult& result,
                 const UnitAddress& unit) {
    RowWriter<CellRecord> cell_rows(database, "cell", "cell_id, scenario_id, noise_level_id, sensor_set_id");
    RowWriter<CellNodeRecord> node_rows(database, "cell_node", "cell_id");
    RowWriter<CellBlockRow> block_rows(database, "cell_block", "cell_id");
    std::vector<CellBlockRow> blocks;
    for (const CellRecord& cell : result.cells) {
        const std::int64_t set_id = id_at(ids.sensor_sets, cell.set_index, "sensor set");
        const std::int64_t id =
            cell_id(ids, result.scenario_index, result.noise_index, cell.set_index, cell.method);
        cell_rows.write(cell, id, unit.scenario_id, unit.noise_level_id, set_id);
        node_rows.write_all(cell.nodes, id);
        blocks.clear();
        for (const double mean_abs_error_N : cell.block_mean_abs_error_N) {
            blocks.push_back({static_cast<int>(blocks.size()), mean_abs_error_N});
        }
        block_rows.write_all(blocks, id);
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
    for (const SingleSensorRecord& sensor : result.sensors) {
        rows.write(sensor, unit.scenario_id, unit.noise_level_id);
        node_rows.write_all(sensor.nodes, unit.scenario_id, unit.noise_level_id, sensor.knowledge,
                            sensor.sensor_node);
    }
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
    weight_rows.write_all(result.weights, unit.scenario_id, unit.noise_level_id);
    write_cells(database, ids, result, unit);
    RowWriter<KnownDirectionBoundRecord> bound_rows(database, "known_direction_bound",
                                                    "scenario_id, noise_level_id, sensor_set_id");
    for (const KnownDirectionBoundRecord& bound : result.bounds) {
        bound_rows.write(bound, unit.scenario_id, unit.noise_level_id,
                         id_at(ids.sensor_sets, bound.set_index, "sensor set"));
    }
    transaction.commit();
}

}  // namespace capstan::storage
