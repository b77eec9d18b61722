#include "capstan/service/layout_scorer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/fusion_stage.h"

namespace capstan::service {

namespace {

constexpr int max_repetitions = 2000;
constexpr int one_thread = 1;  // a study may be running at the same time

StudyPlan short_enough(StudyPlan plan) {
    plan.repetitions = std::min(plan.repetitions, max_repetitions);
    return plan;
}

std::vector<int> from_zero(std::vector<int> nodes) {
    std::sort(nodes.begin(), nodes.end());
    for (int& node : nodes) --node;
    return nodes;
}

}  // namespace

LayoutScorer::LayoutScorer(StudyPlan plan) : plan_(short_enough(std::move(plan))), study_(prepare(plan_)) {}

void LayoutScorer::check(const LayoutQuestion& question) const {
    std::vector<std::string> problems;
    std::vector<int> nodes = question.nodes;
    std::sort(nodes.begin(), nodes.end());
    if (nodes.empty()) problems.push_back("no sensor is placed; place one or more");
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
        problems.push_back("a node carries two sensors; name each node once");
    if (!nodes.empty() && (nodes.front() < 1 || nodes.back() > study_.nodes()))
        problems.push_back(fmt::format("nodes count from 1 (motor) to {} (load)", study_.nodes()));
    if (find_fusion_method(question.method) == nullptr)
        problems.push_back(fmt::format("there is no fusion method '{}'", question.method));
    if (question.noise_index < 0 || question.noise_index >= static_cast<int>(plan_.noise_levels.size()))
        problems.push_back(fmt::format("the study has noise levels 1 to {}", plan_.noise_levels.size()));
    const auto in_regime = [&](const PreparedScenario& each) {
        return name_of(each.regime) == question.regime;
    };
    if (std::none_of(study_.scenarios.begin(), study_.scenarios.end(), in_regime))
        problems.push_back(fmt::format("the study has no instant in regime '{}'", question.regime));
    if (!problems.empty()) throw InvalidInput(problems);
}

const LayoutScorer::Solved& LayoutScorer::solved(int scenario, int noise) {
    const auto found = kept_.find({scenario, noise});
    if (found != kept_.end()) return found->second;
    const StudyPoint point{scenario, noise};
    double ignored_s = 0.0;
    SolvedReadings readings = solve_readings(study_, point, one_thread, ignored_s);
    auto errors_N = sensor_errors_N(summarise_sensors(study_, point, readings, one_thread));
    return kept_.emplace(std::pair{scenario, noise}, Solved{std::move(readings), std::move(errors_N)})
        .first->second;
}

std::vector<double> LayoutScorer::weights(int scenario, int noise) {
    std::vector<std::vector<double>> errors_N(study_.scenarios.size());
    for (int source = 0; source < static_cast<int>(study_.scenarios.size()); ++source) {
        if (gives_weights(study_, source, scenario)) errors_N[source] = solved(source, noise).sensor_error_N;
    }
    return sensor_weights(study_, errors_N, scenario);
}

LayoutScore LayoutScorer::score(const LayoutQuestion& question) {
    const std::lock_guard lock(mutex_);
    check(question);
    // The study's instants with another set of sensors and one method.
    study_.sensor_sets = {from_zero(question.nodes)};
    study_.methods = {find_fusion_method(question.method)};
    LayoutScore score;
    score.repetitions = plan_.repetitions;
    for (int node = 1; node <= study_.nodes(); ++node) score.nodes.push_back({node, 0.0, 0.0});
    double variance_N2 = 0.0;
    for (int s = 0; s < static_cast<int>(study_.scenarios.size()); ++s) {
        if (name_of(study_.scenarios[s].regime) != question.regime) continue;
        FusionTimes ignored;
        const Solved& readings = solved(s, question.noise_index);
        const auto result = fuse_readings(study_, {s, question.noise_index}, readings.readings,
                                          weights(s, question.noise_index), one_thread, ignored);
        const storage::CellRecord& cell = result.cells.front();
        ++score.instants;
        score.mean_abs_error_N += cell.mean_abs_error_N;
        variance_N2 += cell.standard_error_N * cell.standard_error_N;
        for (std::size_t k = 0; k < cell.nodes.size(); ++k) {
            score.nodes[k].mean_abs_error_N += cell.nodes[k].mean_abs_error_N;
            score.nodes[k].bias_N += cell.nodes[k].bias_N;
        }
    }
    score.mean_abs_error_N /= score.instants;
    for (NodeError& node : score.nodes) {
        node.mean_abs_error_N /= score.instants;
        node.bias_N /= score.instants;
    }
    const double half_N = normal_95 * std::sqrt(variance_N2) / score.instants;
    score.interval_low_N = score.mean_abs_error_N - half_N;
    score.interval_high_N = score.mean_abs_error_N + half_N;
    return score;
}

}  // namespace capstan::service
