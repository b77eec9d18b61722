#include "capstan/placement/replay.h"

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/fusion_stage.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"

namespace capstan {

namespace {

void demand_inside(const PreparedStudy& study, const ReplayAddress& address) {
    std::vector<std::string> problems;
    const auto check = [&](int value, std::size_t count, const char* what) {
        if (value < 0 || value >= static_cast<int>(count)) {
            problems.push_back(std::string(what) + " " + std::to_string(value) +
                               " is not in the study; it has 0 to " + std::to_string(count - 1));
        }
    };
    check(address.scenario_index, study.scenarios.size(), "scenario");
    check(address.noise_index, study.plan.noise_levels.size(), "noise level");
    check(address.repetition, static_cast<std::size_t>(study.plan.repetitions), "repetition");
    if (!problems.empty()) throw InvalidInput(problems);
}

std::string direction_signs(const DirectionBits& bits, int segments) {
    std::string signs;
    for (int i = 0; i < segments; ++i)
        signs += bits.forward >> i & 1 ? '+' : bits.backward >> i & 1 ? '-' : '0';
    return signs;
}

// The weights need the complete single-sensor stage, so it is run as in the study.
std::vector<double> weights_of(const PreparedStudy& study, const ReplayAddress& address, int jobs) {
    std::vector<std::vector<double>> errors_N;
    for (int s = 0; s < static_cast<int>(study.scenarios.size()); ++s) {
        const StudyPoint point{s, address.noise_index};
        double unused_s = 0.0;
        const SolvedReadings solved = solve_readings(study, point, jobs, unused_s);
        errors_N.push_back(sensor_errors_N(summarise_sensors(study, point, solved, jobs)));
    }
    return sensor_weights(study, errors_N, address.scenario_index);
}

}  // namespace

Replay replay(const StudyPlan& plan, const ReplayAddress& address, int jobs) {
    const PreparedStudy study = prepare(plan);
    demand_inside(study, address);
    const StudyPoint point{address.scenario_index, address.noise_index};
    const PreparedScenario& scenario = study.scenarios[address.scenario_index];
    SolvedReadings solved;
    solved.nodes = study.nodes();
    const std::size_t size = static_cast<std::size_t>(address.repetition + 1) * solved.nodes;
    solved.reading_N.resize(size);
    solved.branch.resize(size);
    solved.verifying.resize(size);
    solve_block(study, point, address.repetition, address.repetition + 1, solved);

    Replay replayed;
    replayed.true_tension_N = scenario.truth.tension_N;
    for (int sensor = 0; sensor < solved.nodes; ++sensor) {
        const std::size_t slot = solved.at(address.repetition, sensor);
        const SensorBranch& branch = scenario.estimator.branches(sensor)[solved.branch[slot]];
        ReplayedSensor seen{sensor,
                            solved.reading_N[slot],
                            solved.verifying[slot],
                            direction_signs(branch.directions, solved.nodes - 1),
                            {}};
        for (int node = 0; node < solved.nodes; ++node) {
            seen.tension_N.push_back(branch.tension_N(node, seen.reading_N));
        }
        replayed.sensors.push_back(std::move(seen));
    }
    const auto estimates =
        fuse_repetition(study, point, solved, weights_of(study, address, jobs), address.repetition);
    for (const PlannedLayout& planned : study.layouts) {
        for (std::size_t m = 0; m < study.methods.size(); ++m) {
            ReplayedEstimate estimate{planned.layout.label, planned.layout.nodes,
                                      std::string(study.methods[m]->name),
                                      estimates[planned.set_index * study.methods.size() + m], 0.0};
            for (int node = 0; node < solved.nodes; ++node) {
                estimate.mean_abs_error_N +=
                    std::abs(estimate.tension_N[node] - scenario.truth.tension_N[node]) / solved.nodes;
            }
            replayed.estimates.push_back(std::move(estimate));
        }
    }
    return replayed;
}

}  // namespace capstan
