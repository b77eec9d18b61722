#include <fmt/format.h>

#include <cmath>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/study_answers.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/study_store.h"

namespace capstan::answers {

namespace {

using reports::Data;
using storage::StudyDescription;

Data scenarios_data(const StudyDescription& study) {
    Data rows = Data::list();
    for (std::size_t k = 0; k < study.scenarios.size(); ++k) {
        const auto& scenario = study.scenarios[k];
        rows.push_back({{"scenario", k + 1},
                        {"regime", scenario.regime},
                        {"sample", scenario.sample},
                        {"time_s", scenario.time_s},
                        {"motion", scenario.motion}});
    }
    return rows;
}

Data noise_data(const StudyDescription& study) {
    Data rows = Data::list();
    for (std::size_t k = 0; k < study.noise_levels.size(); ++k) {
        const auto& level = study.noise_levels[k];
        rows.push_back({{"noise", k + 1},
                        {"label", level.label},
                        {"multiplicative_ratio", level.multiplicative_ratio},
                        {"additive_N", level.additive_N},
                        {"bias_N", level.bias_N},
                        {"quantisation_N", level.quantisation_N},
                        {"range_N", level.range_N}});
    }
    return rows;
}

std::string description_of(const StudyDescription& study) {
    double length_m = 0.0;
    double wrap_rad = 0.0;
    for (const auto& segment : study.cable_segments) {
        length_m += segment.length_m;
        wrap_rad += segment.wrap_angle_rad;
    }
    std::string methods;
    for (const auto& method : study.fusion_methods) methods += (methods.empty() ? "" : ", ") + method.title;
    return fmt::format(
        "Cable: {:.4g} m in {} segments with {:.4g} rad of wrap, nodes 1 to {}. Draws: {}, seed {}. Layouts: {}, with "
        "{} different sets of sensors. Methods: {}. Program: capstan {}.",
        length_m, study.study.segments, wrap_rad, study.study.segments + 1,
        counted(static_cast<std::size_t>(study.study.repetitions), "repetition"), study.study.seed,
        study.layouts.size(), study.sensor_sets.size(), methods, study.study.program_version);
}

}  // namespace

namespace {

void add_integrity(reports::Answer& answer, storage::Database& database, std::int64_t study_id) {
    Data computations = Data::list();
    for (const storage::Computation& computation : storage::read_computations(database, study_id))
        computations.push_back({{"simd", computation.simd},
                                {"compiler", computation.compiler},
                                {"program_version", computation.program_version}});
    answer.values["content_sha256"] = storage::study_hash(database, study_id);
    answer.values["computed_with"] = std::move(computations);
}

// A study over worlds: how many trials of each condition are stored.
reports::Answer world_study_answer(storage::Database& database, std::int64_t study_id,
                                   const StudyDescription& study) {
    const auto& head = study.study;
    storage::Statement statement(
        database,
        "SELECT condition, count(DISTINCT candidate_index), count(*) FROM world_error WHERE "
        "study_id = ?1 GROUP BY condition ORDER BY condition");
    statement.bind(1, study_id);
    Data conditions = Data::list();
    while (statement.step())
        conditions.push_back({{"condition", statement.get<std::string>(0)},
                              {"sets", statement.get<std::int64_t>(1)},
                              {"trials", statement.get<std::int64_t>(2)}});
    reports::Answer answer{
        .id = "study_description",
        .kind = "A stored study over worlds",
        .title = fmt::format("Study {} ({})", study_id, head.name),
        .headline = fmt::format("{}; {} sets of sensors.", head.status, study.world_candidates.size() - 1)};
    answer.values = {{"study_id", study_id},      {"name", head.name},
                     {"status", head.status},     {"program_version", head.program_version},
                     {"seed", head.seed},         {"repetitions", head.repetitions},
                     {"segments", head.segments}, {"candidates", study.world_candidates.size()},
                     {"conditions", conditions},  {"config_toml", head.config_toml}};
    answer.sections = {
        {.id = "trials",
         .heading = "Trials that are stored",
         .prose =
             fmt::format("Draws: {} worlds to choose and as many to judge, seed {}. Program: capstan {}.",
                         head.repetitions, head.seed, head.program_version),
         .tables = {{"trials",
                     "",
                     {{"condition", "condition"}, {"sets", "sets"}, {"trials", "sets times worlds"}},
                     conditions}}}};
    add_integrity(answer, database, study_id);
    return answer;
}

}  // namespace

reports::Answer study_answer(storage::Database& database, std::int64_t study_id) {
    const StudyDescription study = storage::load_study(database, study_id);
    if (!study.world_candidates.empty()) return world_study_answer(database, study_id, study);
    const std::size_t units = study.work_units.size();
    const std::size_t done = units - storage::pending_units(database, study_id).size();
    const auto& head = study.study;
    Data methods = Data::list();
    for (const auto& method : study.fusion_methods) methods.push_back(method.method);
    reports::Answer answer{.id = "study_description",
                           .kind = "A stored study",
                           .title = fmt::format("Study {} ({})", study_id, head.name),
                           .headline = fmt::format("{}, {} of {} units.", head.status, done, units)};
    answer.values = {{"study_id", study_id},
                     {"name", head.name},
                     {"status", head.status},
                     {"units_done", done},
                     {"units", units},
                     {"program_version", head.program_version},
                     {"seed", head.seed},
                     {"repetitions", head.repetitions},
                     {"segments", head.segments},
                     {"layouts", study.layouts.size()},
                     {"sensor_sets", study.sensor_sets.size()},
                     {"methods", methods},
                     {"scenarios", scenarios_data(study)},
                     {"noise_levels", noise_data(study)},
                     {"config_toml", head.config_toml}};
    answer.sections = {
        {.id = "description", .prose = description_of(study)},
        {.id = "scenarios",
         .heading = "Instants (scenarios)",
         .tables = {{"scenarios",
                     "",
                     {{"scenario", "number"},
                      {"regime", "regime"},
                      {"sample", "sample"},
                      {"time_s", "time", "s", ".3f"},
                      {"motion", "motor end moves"}},
                     answer.values["scenarios"]}}},
        {.id = "noise",
         .heading = "Noise levels",
         .tables =
             {{"noise_levels", "", {{"noise", "number"}, {"label", "label"}}, answer.values["noise_levels"]}},
         .note = head.status == "complete"
                     ? fmt::format("`capstan recommend {0}` prints its recommendations; `capstan study "
                                   "show {0} --config` prints its configuration.",
                                   study_id)
                     : fmt::format("`capstan study resume {0}` completes it.", study_id)}};
    add_integrity(answer, database, study_id);
    return answer;
}

storage::QueryResult studies_table(storage::Database& database, storage::Shelf shelf) {
    storage::QueryResult table{
        {"study_id", "name", "status", "units_done", "units", "begun_utc", "note", "tags"}, {}};
    for (const storage::StudySummary& study : storage::list_studies(database, shelf))
        table.rows.push_back({study.study_id, study.name, study.status, std::int64_t{study.units_done},
                              std::int64_t{study.units}, study.begun_utc, study.note, study.tags});
    return table;
}

reports::Answer replay_answer(const Replay& replayed, const storage::ScenarioRecord& scenario,
                              const std::string& noise, std::int64_t repetition) {
    reports::Answer answer{
        .id = "replay",
        .kind = "One repetition of a study",
        .title = fmt::format("Repetition {}", repetition),
        .headline = fmt::format("sample {} ({}), noise {}.", scenario.sample, scenario.regime, noise)};
    answer.values = {
        {"true_tension_N", replayed.true_tension_N}, {"sensors", Data::list()}, {"estimates", Data::list()}};
    for (const ReplayedSensor& sensor : replayed.sensors) {
        double error_N = 0.0;
        for (std::size_t node = 0; node < sensor.tension_N.size(); ++node) {
            error_N += std::abs(sensor.tension_N[node] - replayed.true_tension_N[node]) /
                       static_cast<double>(sensor.tension_N.size());
        }
        answer.values["sensors"].push_back(
            {{"node", sensor.node + 1},
             {"true_N", replayed.true_tension_N[static_cast<std::size_t>(sensor.node)]},
             {"reading_N", sensor.reading_N},
             {"error_N", error_N},
             {"verifying_patterns", sensor.verifying_patterns},
             {"directions", sensor.directions},
             {"tension_N", sensor.tension_N}});
    }
    for (const ReplayedEstimate& estimate : replayed.estimates) {
        answer.values["estimates"].push_back({{"layout", estimate.layout},
                                              {"nodes", from_one(estimate.nodes)},
                                              {"method", estimate.method},
                                              {"mean_abs_error_N", estimate.mean_abs_error_N},
                                              {"tension_N", estimate.tension_N}});
    }
    answer.sections = {
        {.id = "sensors",
         .heading = "Each sensor alone, direction unknown",
         .tables = {{"sensors",
                     "",
                     {{"node", "node"},
                      {"true_N", "true tension", "N", ".3f"},
                      {"reading_N", "reading", "N", ".3f"},
                      {"error_N", "error", "N", ".3f"},
                      {"directions", "directions"},
                      {"verifying_patterns", "patterns that verify"}},
                     answer.values["sensors"]}},
         .note = "Directions of the segments: + towards the load, - towards the motor, 0 at rest."},
        {.id = "estimates",
         .heading = "Fused",
         .tables = {{"estimates",
                     "",
                     {{"layout", "layout"},
                      {"nodes", "nodes"},
                      {"method", "method"},
                      {"mean_abs_error_N", "error", "N", ".4f"}},
                     answer.values["estimates"]}}}};
    return answer;
}

}  // namespace capstan::answers
