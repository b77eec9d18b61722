#include "capstan/placement/single_sensor_stage.h"

#include <algorithm>
#include <cmath>

#include "capstan/estimation/consensus.h"
#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/intervals.h"
#include "capstan/placement/repetition_blocks.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/parallel_for.h"

namespace capstan {

namespace {

// The tension profile that a reading gives, whichever branch it takes.
struct ProfileOf {
    const SensorBranch& branch;
    double reading_N;
    double operator()(int node) const { return branch.tension_N(node, reading_N); }
};

// The single-sensor estimates of one sensor over all repetitions, direction known or unknown.
template <typename BranchOf>
storage::SingleSensorRecord summarise_sensor(const PreparedScenario& scenario, int repetitions, int sensor,
                                             const SolvedReadings& solved, const BranchOf& branch_of) {
    const int nodes = solved.nodes;
    std::vector<double> repetition_error_N(repetitions, 0.0);
    std::vector<double> tension_N(repetitions);
    storage::SingleSensorRecord record;
    record.sensor_node = sensor + 1;
    for (int node = 0; node < nodes; ++node) {
        const double truth_N = scenario.truth.tension_N[node];
        double error_sum_N = 0.0;
        double tension_sum_N = 0.0;
        for (int r = 0; r < repetitions; ++r) {
            tension_N[r] = ProfileOf{branch_of(r), solved.reading_N[solved.at(r, sensor)]}(node);
            const double error_N = std::abs(tension_N[r] - truth_N);
            error_sum_N += error_N;
            tension_sum_N += tension_N[r];
            repetition_error_N[r] += error_N / nodes;
        }
        record.nodes.push_back({node + 1, error_sum_N / repetitions, tension_sum_N / repetitions,
                                quantile(tension_N, 0.025), quantile(tension_N, 0.975)});
    }
    const MeanAndError mean = mean_and_error(repetition_error_N);
    record.mean_abs_error_N = mean.mean;
    record.standard_error_N = mean.standard_error;
    return record;
}

storage::SingleSensorRecord summarise_known(const PreparedStudy& study, const PreparedScenario& scenario,
                                            int sensor, const SolvedReadings& solved) {
    SensorBranch at_rest;  // the reading says nothing: the previous state
    at_rest.intercept_N = scenario.previous.tension_N;
    at_rest.slope.assign(solved.nodes, 0.0);
    const auto& known = scenario.known_branch[sensor];
    const SensorBranch& branch = known ? *known : at_rest;
    auto record = summarise_sensor(scenario, study.plan.repetitions, sensor, solved,
                                   [&](int) -> const SensorBranch& { return branch; });
    record.knowledge = "direction_known";
    record.at_rest_fraction = known ? 0.0 : 1.0;
    return record;
}

storage::SingleSensorRecord summarise_unknown(const PreparedStudy& study, const PreparedScenario& scenario,
                                              int sensor, const SolvedReadings& solved) {
    const int repetitions = study.plan.repetitions;
    const auto branches = scenario.estimator.branches(sensor);
    const auto branch_of = [&](int r) -> const SensorBranch& {
        return branches[solved.branch[solved.at(r, sensor)]];
    };
    auto record = summarise_sensor(scenario, repetitions, sensor, solved, branch_of);
    record.knowledge = "direction_unknown";
    int unverified = 0;
    int ambiguous = 0;
    int at_rest = 0;
    for (int r = 0; r < repetitions; ++r) {
        const int verifying = solved.verifying[solved.at(r, sensor)];
        unverified += verifying == 0;
        ambiguous += verifying > 1;
        at_rest += (moving_nodes(branch_of(r).directions) >> sensor & 1) == 0;
    }
    record.unverified_fraction = static_cast<double>(unverified) / repetitions;
    record.ambiguous_fraction = static_cast<double>(ambiguous) / repetitions;
    record.at_rest_fraction = static_cast<double>(at_rest) / repetitions;
    return record;
}

}  // namespace

namespace {

SolvedReadings room_for(int repetitions, int nodes) {
    const std::size_t size = static_cast<std::size_t>(repetitions) * nodes;
    return {nodes, std::vector<double>(size), std::vector<std::uint16_t>(size),
            std::vector<std::uint8_t>(size)};
}

void read_repetition(const PreparedStudy& study, const StudyPoint& point, int r, SolvedReadings& solved) {
    const NoiseLevel& noise = study.plan.noise_levels[point.noise_index].level;
    const ReadingDraws draws =
        draw_readings({study.plan.seed, static_cast<std::uint32_t>(point.scenario_index),
                       point.first_draw + static_cast<std::uint32_t>(r)},
                      solved.nodes, noise);
    const std::span<double> readings(solved.reading_N.data() + solved.at(r, 0), solved.nodes);
    read_tensions(noise, draws, study.scenarios[point.scenario_index].truth.tension_N, readings);
}

// A sensor without error gets a very large weight, not an infinite one.
constexpr double smallest_error_N = 1e-12;

}  // namespace

void solve_block(const PreparedStudy& study, const StudyPoint& point, int first, int end,
                 SolvedReadings& solved) {
    const PreparedScenario& scenario = study.scenarios[point.scenario_index];
    for (int r = first; r < end; ++r) {
        read_repetition(study, point, r, solved);
        for (int node = 0; node < solved.nodes; ++node) {
            const auto choice = scenario.estimator.choose(node, solved.reading_N[solved.at(r, node)]);
            solved.branch[solved.at(r, node)] = static_cast<std::uint16_t>(choice.branch);
            solved.verifying[solved.at(r, node)] =
                static_cast<std::uint8_t>(std::min(choice.verifying_patterns, 255));
        }
    }
}

SolvedReadings only_readings(const PreparedStudy& study, const StudyPoint& point) {
    SolvedReadings solved = room_for(study.plan.repetitions, study.nodes());
    for (int r = 0; r < study.plan.repetitions; ++r) read_repetition(study, point, r, solved);
    return solved;
}

SolvedReadings solve_readings(const PreparedStudy& study, const StudyPoint& point, int jobs,
                              double& processor_time_s) {
    return solve_readings(study, point, study.plan.repetitions, jobs, processor_time_s);
}

SolvedReadings solve_readings(const PreparedStudy& study, const StudyPoint& point, int repetitions, int jobs,
                              double& processor_time_s) {
    SolvedReadings solved = room_for(repetitions, study.nodes());
    const RepetitionBlocks blocks{repetitions};
    std::vector<double> block_time_s(blocks.count());
    parallel_for_each_index(blocks.count(), jobs, [&](int block) {
        const double start_s = thread_processor_time_s();
        solve_block(study, point, blocks.first(block), blocks.end(block), solved);
        block_time_s[block] = thread_processor_time_s() - start_s;
    });
    for (const double time_s : block_time_s) processor_time_s += time_s;
    return solved;
}

storage::SingleSensorResult summarise_sensors(const PreparedStudy& study, const StudyPoint& point,
                                              const SolvedReadings& solved, int jobs) {
    const PreparedScenario& scenario = study.scenarios[point.scenario_index];
    storage::SingleSensorResult result{point.scenario_index, point.noise_index, {}};
    result.sensors.resize(2 * static_cast<std::size_t>(solved.nodes));
    parallel_for_each_index(solved.nodes, jobs, [&](int sensor) {
        result.sensors[sensor] = summarise_known(study, scenario, sensor, solved);
        result.sensors[solved.nodes + sensor] = summarise_unknown(study, scenario, sensor, solved);
    });
    return result;
}

std::vector<double> sensor_errors_N(const storage::SingleSensorResult& result) {
    std::vector<double> errors;
    for (const storage::SingleSensorRecord& sensor : result.sensors) {
        if (sensor.knowledge == "direction_unknown") errors.push_back(sensor.mean_abs_error_N);
    }
    return errors;
}

bool gives_weights(const PreparedStudy& study, int source_index, int fused_index) {
    const Regime source = study.scenarios[source_index].regime;
    switch (study.plan.weight_source) {
        case WeightSource::mass_motion:
            return source == Regime::mass;
        case WeightSource::same_regime:
            return source == study.scenarios[fused_index].regime;
    }
    return false;
}

std::vector<double> sensor_weights(const PreparedStudy& study,
                                   const std::vector<std::vector<double>>& errors_N, int scenario_index) {
    std::vector<double> mean_N(study.nodes(), 0.0);
    int sources = 0;
    for (int s = 0; s < static_cast<int>(study.scenarios.size()); ++s) {
        if (!gives_weights(study, s, scenario_index)) continue;
        for (int node = 0; node < study.nodes(); ++node) mean_N[node] += errors_N[s][node];
        ++sources;
    }
    // Without a source no W method is in the plan; any weights will do.
    if (sources == 0) return std::vector<double>(study.nodes(), 1.0);
    std::vector<double> weight;
    for (const double sum_N : mean_N) weight.push_back(1.0 / std::max(sum_N / sources, smallest_error_N));
    return weight;
}

}  // namespace capstan
