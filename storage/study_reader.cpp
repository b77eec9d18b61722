// Results and conclusions, read back into records.
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"

namespace capstan::storage {
namespace {

// Hands out the rows of a second query that belong to the rows of a first, both ascending by the same id:
// one query for all children, not one per parent.
class ChildRows {
  public:
    explicit ChildRows(Statement& rows) : rows_(rows), more_(rows.step()) {}

    template <class Take>
    void of(std::int64_t parent_id, Take take) {
        while (more_ && rows_.get<std::int64_t>(0) == parent_id) {
            take(rows_);
            more_ = rows_.step();
        }
    }

  private:
    Statement& rows_;  // column 0: the parent's id
    bool more_;
};

const std::string cells_of_instant = "cell WHERE scenario_id = ?1 AND noise_level_id = ?2";

template <class Record>
std::vector<Record> children_of(Database& database, const std::string& table, std::int64_t recommendation_id,
                                const StudyIds& ids) {
    Statement select(database, "SELECT sensor_set_id, " + column_names<Record>() + " FROM " + table +
                                   " WHERE recommendation_id = ?1");
    select.bind(1, recommendation_id);
    std::vector<Record> records;
    while (select.step()) {
        records.push_back(read_record<Record>(select, 1));
        records.back().set_index = index_of(ids.sensor_sets, select.get<std::int64_t>(0));
    }
    return records;
}

}  // namespace

std::vector<SingleSensorRecord> read_single_sensor(Database& database, std::int64_t study_id,
                                                   int scenario_index, int noise_index) {
    const StudyIds ids = load_study_ids(database, study_id);
    const std::int64_t scenario_id = id_at(ids.scenarios, scenario_index, "scenario");
    const std::int64_t noise_level_id = id_at(ids.noise_levels, noise_index, "noise level");
    Statement sensors(database, "SELECT " + column_names<SingleSensorRecord>() +
                                    " FROM single_sensor WHERE scenario_id = ?1 AND noise_level_id = ?2 "
                                    "ORDER BY knowledge, sensor_node");
    Statement nodes(database, "SELECT " + column_names<SingleSensorNodeRecord>() +
                                  " FROM single_sensor_node WHERE scenario_id = ?1 AND noise_level_id = ?2 "
                                  "AND knowledge = ?3 AND sensor_node = ?4 ORDER BY node");
    sensors.bind_all(scenario_id, noise_level_id);
    std::vector<SingleSensorRecord> records;
    while (sensors.step()) {
        SingleSensorRecord sensor = read_record<SingleSensorRecord>(sensors);
        nodes.bind_all(scenario_id, noise_level_id, sensor.knowledge, sensor.sensor_node);
        while (nodes.step()) sensor.nodes.push_back(read_record<SingleSensorNodeRecord>(nodes));
        nodes.reset();
        records.push_back(std::move(sensor));
    }
    return records;
}

FusionResult read_fusion(Database& database, std::int64_t study_id, int scenario_index, int noise_index) {
    const StudyIds ids = load_study_ids(database, study_id);
    const std::int64_t scenario_id = id_at(ids.scenarios, scenario_index, "scenario");
    const std::int64_t noise_level_id = id_at(ids.noise_levels, noise_index, "noise level");
    FusionResult result{scenario_index, noise_index, {}, {}, {}};

    Statement weights(database, "SELECT " + column_names<SensorWeightRecord>() +
                                    " FROM sensor_weight WHERE scenario_id = ?1 AND noise_level_id = ?2 "
                                    "ORDER BY sensor_node");
    weights.bind_all(scenario_id, noise_level_id);
    while (weights.step()) result.weights.push_back(read_record<SensorWeightRecord>(weights));

    Statement cells(database, "SELECT cell_id, sensor_set_id, " + column_names<CellRecord>() + " FROM " +
                                  cells_of_instant + " ORDER BY cell_id");
    Statement nodes(database, "SELECT cell_id, " + column_names<CellNodeRecord>() +
                                  " FROM cell_node WHERE cell_id IN (SELECT cell_id FROM " +
                                  cells_of_instant + ") ORDER BY cell_id, node");
    Statement blocks(database,
                     "SELECT cell_id, mean_abs_error_N FROM cell_block WHERE cell_id IN "
                     "(SELECT cell_id FROM " +
                         cells_of_instant + ") ORDER BY cell_id, block");
    for (Statement* statement : {&cells, &nodes, &blocks}) statement->bind_all(scenario_id, noise_level_id);
    ChildRows node_rows(nodes);
    ChildRows block_rows(blocks);
    while (cells.step()) {
        const auto id = cells.get<std::int64_t>(0);
        CellRecord cell = read_record<CellRecord>(cells, 2);
        cell.set_index = index_of(ids.sensor_sets, cells.get<std::int64_t>(1));
        node_rows.of(
            id, [&](const Statement& row) { cell.nodes.push_back(read_record<CellNodeRecord>(row, 1)); });
        block_rows.of(
            id, [&](const Statement& row) { cell.block_mean_abs_error_N.push_back(row.get<double>(1)); });
        result.cells.push_back(std::move(cell));
    }

    Statement bounds(database,
                     "SELECT sensor_set_id, " + column_names<KnownDirectionBoundRecord>() +
                         " FROM known_direction_bound WHERE scenario_id = ?1 AND noise_level_id = ?2 "
                         "ORDER BY sensor_set_id");
    bounds.bind_all(scenario_id, noise_level_id);
    while (bounds.step()) {
        auto bound = read_record<KnownDirectionBoundRecord>(bounds, 1);
        bound.set_index = index_of(ids.sensor_sets, bounds.get<std::int64_t>(0));
        result.bounds.push_back(bound);
    }
    return result;
}

std::vector<CellSummary> read_cell_summaries(Database& database, std::int64_t study_id, int noise_index) {
    const StudyIds ids = load_study_ids(database, study_id);
    const std::int64_t noise_level_id = id_at(ids.noise_levels, noise_index, "noise level");
    Statement cells(database,
                    "SELECT cell_id, scenario_id, sensor_set_id, method, mean_abs_error_N, standard_error_N "
                    "FROM cell WHERE noise_level_id = ?1 ORDER BY cell_id");
    Statement blocks(database,
                     "SELECT b.cell_id, b.mean_abs_error_N FROM cell c JOIN cell_block b USING (cell_id) "
                     "WHERE c.noise_level_id = ?1 ORDER BY b.cell_id, b.block");
    cells.bind(1, noise_level_id);
    blocks.bind(1, noise_level_id);
    ChildRows block_rows(blocks);
    std::vector<CellSummary> summaries;
    while (cells.step()) {
        CellSummary cell{index_of(ids.scenarios, cells.get<std::int64_t>(1)),
                         index_of(ids.sensor_sets, cells.get<std::int64_t>(2)),
                         cells.get<std::string>(3),
                         cells.get<double>(4),
                         cells.get<double>(5),
                         {}};
        block_rows.of(cells.get<std::int64_t>(0), [&](const Statement& row) {
            cell.block_mean_abs_error_N.push_back(row.get<double>(1));
        });
        summaries.push_back(std::move(cell));
    }
    return summaries;
}

std::vector<LayoutErrorSummary> read_errors_by_layout(Database& database, std::int64_t study_id,
                                                      int noise_index) {
    const StudyIds ids = load_study_ids(database, study_id);
    Statement rows(database,
                   "SELECT regime, family, sensor_count, method, mean_abs_error_N, standard_error_N "
                   "FROM v_error_by_layout WHERE study_id = ?1 AND noise_level_id = ?2 "
                   "ORDER BY regime, family, sensor_count, method");
    rows.bind_all(study_id, id_at(ids.noise_levels, noise_index, "noise level"));
    std::vector<LayoutErrorSummary> errors;
    while (rows.step()) {
        errors.push_back({rows.get<std::string>(0), rows.get<std::string>(1), rows.get<int>(2),
                          rows.get<std::string>(3), rows.get<double>(4), rows.get<double>(5)});
    }
    return errors;
}

std::vector<RecommendationRecord> read_recommendations(Database& database, std::int64_t study_id) {
    const StudyIds ids = load_study_ids(database, study_id);
    Statement select(database, "SELECT recommendation_id, noise_level_id, sensor_set_id, " +
                                   column_names<RecommendationRecord>() +
                                   " FROM recommendation WHERE study_id = ?1 ORDER BY recommendation_id");
    select.bind(1, study_id);
    std::vector<RecommendationRecord> records;
    while (select.step()) {
        const auto id = select.get<std::int64_t>(0);
        RecommendationRecord record = read_record<RecommendationRecord>(select, 3);
        record.noise_index = index_of(ids.noise_levels, select.get<std::int64_t>(1));
        record.set_index = index_of(ids.sensor_sets, select.get<std::int64_t>(2));
        record.counts = children_of<RecommendationCountRecord>(database, "recommendation_count", id, ids);
        record.alternatives =
            children_of<RecommendationAlternativeRecord>(database, "recommendation_alternative", id, ids);
        records.push_back(std::move(record));
    }
    return records;
}

std::vector<PaperComparisonRecord> read_paper_comparison(Database& database, std::int64_t study_id) {
    Statement select(database, "SELECT " + column_names<PaperComparisonRecord>() +
                                   " FROM paper_comparison WHERE study_id = ?1 ORDER BY row_index");
    select.bind(1, study_id);
    std::vector<PaperComparisonRecord> records;
    while (select.step()) records.push_back(read_record<PaperComparisonRecord>(select));
    return records;
}

}  // namespace capstan::storage
