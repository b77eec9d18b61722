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

constexpr int band_repetitions = 400;  // enough for quantiles at 5% and 95%
constexpr std::string_view duty_cycle = "duty_cycle";

using WeightedErrors = std::vector<std::pair<double, double>>;  // [N], weight

double weighted_quantile(const WeightedErrors& ascending, double fraction) {
    double total = 0.0, before = 0.0;
    for (const auto& [error_N, weight] : ascending) total += weight;
    for (const auto& [error_N, weight] : ascending)
        if ((before += weight) >= fraction * total) return error_N;
    return ascending.empty() ? 0.0 : ascending.back().first;
}

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
    const auto check_layout = [&](const PlacedLayout& layout) {
        std::vector<int> nodes = layout.nodes;
        std::sort(nodes.begin(), nodes.end());
        if (nodes.empty()) problems.push_back("no sensor is placed; place one or more");
        if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
            problems.push_back("a node carries two sensors; name each node once");
        if (!nodes.empty() && (nodes.front() < 1 || nodes.back() > study_.nodes()))
            problems.push_back(fmt::format("nodes count from 1 (motor) to {} (load)", study_.nodes()));
        if (find_fusion_method(layout.method) == nullptr)
            problems.push_back(fmt::format("there is no fusion method '{}'", layout.method));
    };
    check_layout(question.layout);
    if (question.reference) check_layout(*question.reference);
    if (question.noise_index < 0 || question.noise_index >= static_cast<int>(plan_.noise_levels.size()))
        problems.push_back(fmt::format("the study has noise levels 1 to {}", plan_.noise_levels.size()));
    const auto in_regime = [&](const PreparedScenario& each) {
        return name_of(each.regime) == question.regime;
    };
    if (question.regime != duty_cycle &&
        std::none_of(study_.scenarios.begin(), study_.scenarios.end(), in_regime))
        problems.push_back(fmt::format("the study has no instant in regime '{}'", question.regime));
    if (!problems.empty()) throw InvalidInput(problems);
}

// Each regime counts with its duty fraction, or one regime alone; its instants share that equally.
std::vector<double> LayoutScorer::scenario_weights(const std::string& regime) const {
    std::vector<double> weights(study_.scenarios.size(), 0.0);
    double sum = 0.0;
    for (const RegimeInstants& each : plan_.regimes) {
        const bool is_meant = regime == duty_cycle || regime == name_of(each.regime);
        const auto instants = std::ranges::count(study_.scenarios, each.regime, &PreparedScenario::regime);
        if (!is_meant || instants == 0) continue;
        const double fraction = regime == duty_cycle ? each.duty_fraction : 1.0;
        for (std::size_t s = 0; s < weights.size(); ++s)
            if (study_.scenarios[s].regime == each.regime)
                weights[s] = fraction / static_cast<double>(instants);
        sum += fraction;
    }
    for (double& weight : weights) weight /= sum;
    return weights;
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

LayoutScore LayoutScorer::score_of(const PlacedLayout& layout, const std::vector<double>& scenario_weights,
                                   int noise) {
    // The study's instants with another set of sensors and one method.
    study_.sensor_sets = {from_zero(layout.nodes)};
    study_.methods = {find_fusion_method(layout.method)};
    LayoutScore score;
    score.repetitions = plan_.repetitions;
    for (int node = 1; node <= study_.nodes(); ++node) score.nodes.push_back({.node = node});
    std::vector<WeightedErrors> draws(score.nodes.size());
    for (int s = 0; s < static_cast<int>(study_.scenarios.size()); ++s) {
        const double weight = scenario_weights[s];
        if (weight == 0.0) continue;
        ++score.instants;
        FusionTimes ignored;
        const StudyPoint point{s, noise};
        const SolvedReadings& readings = solved(s, noise).readings;
        const std::vector<double> sensor_weight = weights(s, noise);
        const auto result = fuse_readings(study_, point, readings, sensor_weight, one_thread, ignored);
        const storage::CellRecord& cell = result.cells.front();
        score.error.objective_N += weight * cell.mean_abs_error_N;
        score.error.block_objective_N.resize(cell.block_mean_abs_error_N.size());
        for (std::size_t block = 0; block < cell.block_mean_abs_error_N.size(); ++block)
            score.error.block_objective_N[block] += weight * cell.block_mean_abs_error_N[block];
        for (std::size_t k = 0; k < cell.nodes.size(); ++k) {
            score.nodes[k].mean_abs_error_N += weight * cell.nodes[k].mean_abs_error_N;
            score.nodes[k].bias_N += weight * cell.nodes[k].bias_N;
        }
        for (int r = 0; r < std::min(plan_.repetitions, band_repetitions); ++r) {
            const auto tension_N = fuse_repetition(study_, point, readings, sensor_weight, r).front();
            for (std::size_t k = 0; k < tension_N.size(); ++k)
                draws[k].emplace_back(std::abs(tension_N[k] - study_.scenarios[s].truth.tension_N[k]),
                                      weight);
        }
    }
    for (std::size_t k = 0; k < draws.size(); ++k) {
        std::sort(draws[k].begin(), draws[k].end());
        score.nodes[k].low_N = weighted_quantile(draws[k], 0.05);
        score.nodes[k].high_N = weighted_quantile(draws[k], 0.95);
    }
    score.mean = interval_of(score.error);
    return score;
}

LayoutComparison LayoutScorer::score(const LayoutQuestion& question) {
    const std::lock_guard lock(mutex_);
    check(question);
    const std::vector<double> weights = scenario_weights(question.regime);
    LayoutComparison compared{score_of(question.layout, weights, question.noise_index), std::nullopt, {}};
    if (question.reference) {
        compared.reference = score_of(*question.reference, weights, question.noise_index);
        compared.difference = interval_of(difference_of(compared.placed.error, compared.reference->error));
    }
    return compared;
}

}  // namespace capstan::service
