#include "capstan/placement/sensor_placement.h"

#include <algorithm>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/long_cable_search.h"
#include "capstan/placement/placement_search.h"
#include "capstan/placement/repetition_blocks.h"

namespace capstan {

namespace {

// And beyond this many nodes times layouts an exact search takes many minutes.
constexpr double max_scored_nodes = 1.2e6;

// Beyond this the scores of all candidates do not fit into the memory that a study may take.
constexpr double max_score_bytes = 600.0 * 1024 * 1024;

std::vector<const FusionMethod*> fusable_methods(const PreparedStudy& study) {
    std::vector<const FusionMethod*> methods;
    for (const FusionMethod* method : study.methods) {
        if (method->knowledge != Knowledge::direction_known) methods.push_back(method);
    }
    return methods;
}

EqualBlocks blocks_of(int repetitions) {
    const RepetitionBlocks blocks{repetitions};
    return {blocks.count(), blocks.block_size()};  // rounds up to whole blocks
}

double score_bytes(const PreparedStudy& study, int nodes, int max_sensors, std::size_t methods) {
    const double candidates = SensorSubsets::how_many(nodes, max_sensors) * static_cast<double>(methods);
    const EqualBlocks blocks = blocks_of(study.plan.repetitions);
    const double kept = sizeof(double) * candidates * (blocks.count + 1.0);
    return static_cast<double>(study.scenarios.size()) *
           (kept + block_error_bytes(candidates, study.plan.placement.objective, blocks, study.nodes()));
}

// All sets of nodes if they fit, so that every family is among them; else those that the constraints leave.
std::optional<SensorSubsets> all_subsets(const PreparedStudy& study, std::size_t methods) {
    std::vector<int> all(study.nodes());
    for (int node = 0; node < study.nodes(); ++node) all[node] = node;
    if (score_bytes(study, study.nodes(), study.nodes(), methods) <= max_score_bytes) {
        return SensorSubsets(all, study.nodes());
    }
    const PlacementConstraints constraints(study.plan.placement, study.nodes());
    const std::vector<int> usable = constraints.usable_nodes();
    const int most = constraints.max_sensors();
    if (usable.size() > 63 ||
        SensorSubsets::how_many(static_cast<int>(usable.size()), most) * study.nodes() > max_scored_nodes ||
        score_bytes(study, static_cast<int>(usable.size()), most, methods) > max_score_bytes)
        return std::nullopt;
    return SensorSubsets(usable, most);
}

template <class Visit>
void for_each_layout(CountAnswer& count, const Visit& visit) {
    visit(count.optimum);
    for (JudgedLayout& layout : count.runners_up) visit(layout);
    for (JudgedLayout& layout : count.beside) visit(layout);
}

void judge_afresh(const PlacementScope& scope, const std::vector<ScenarioErrors>& fresh, CountAnswer& count) {
    const std::vector<double> best_N = scope.block_objective_N(fresh, count.optimum.candidate);
    const double best_value_N = scope.objective_N(fresh, count.optimum.candidate);
    for_each_layout(count, [&](JudgedLayout& layout) {
        std::vector<double> own_N = scope.block_objective_N(fresh, layout.candidate);
        const double value_N = scope.objective_N(fresh, layout.candidate);
        layout.fresh = interval_of(value_N, own_N);
        for (std::size_t b = 0; b < own_N.size(); ++b) own_N[b] -= best_N[b];
        layout.difference = interval_of(value_N - best_value_N, own_N);
    });
    count.optimism_N = count.optimum.fresh.value_N - count.optimum.searched_N;
}

// Layouts are allowed, yet none survives a loss well enough.
void refuse_empty(const PlacementSearch& search, const std::vector<PlacementScope>& scopes,
                  const std::vector<ScopeAnswer>& answers) {
    for (std::size_t k = 0; k < answers.size(); ++k) {
        if (!answers[k].counts.empty()) continue;
        char text[200];
        std::snprintf(
            text, sizeof text,
            "placement.largest_error_after_loss_N: no layout that the other constraints allow stays below "
            "it (%s%s); the best leaves %.4g N",
            answers[k].scope.c_str(), answers[k].regime.empty() ? "" : (" " + answers[k].regime).c_str(),
            search.min_after_loss_N(scopes[k]));
        throw InvalidInput({text});
    }
}

double min_resolved_N(const std::vector<ScopeAnswer>& scopes) {
    double worst_N = 0.0;
    for (const ScopeAnswer& scope : scopes) {
        for (const CountAnswer& count : scope.counts) worst_N = std::max(worst_N, count.at_most_better_N);
    }
    return worst_N;
}

}  // namespace

PlacementAnswer place_sensors(const StudyPlan& plan, const PlacementOptions& options) {
    const double start_s = wall_time_s();
    const auto progress = [&](const std::string& message) {
        if (options.on_progress) options.on_progress(message);
    };
    const PreparedStudy study = prepare(plan);
    const std::vector<const FusionMethod*> methods = fusable_methods(study);
    if (methods.empty()) {
        throw InvalidInput(
            {"estimation.methods: only methods that are told the direction are named; name one "
             "that is not, as \"posterior_mean\", or \"all\""});
    }
    const std::optional<SensorSubsets> subsets = all_subsets(study, methods.size());
    if (!subsets) return search_long_cable(plan, options);

    CandidateList candidates{*subsets, methods, {}};
    const auto weights = ScoredDraws::weights(study, options.noise_index, options.jobs);
    ScoredDraws searched(study, options.noise_index, 0, candidates, plan.placement.objective);
    EqualBlocks blocks = blocks_of(plan.repetitions);
    PlacementAnswer answer;
    std::vector<PlacementScope> scopes;
    // Each look at the draws may err with half the chance of the one before, so that all together keep 95%.
    double alpha = options.resolve_to_N ? 0.025 : 0.05;
    for (;; alpha /= 2.0, blocks.count *= 2) {
        const double score_start_s = wall_time_s();
        searched.extend(blocks.count, blocks.size, weights, options.jobs);
        answer.times.score_s += wall_time_s() - score_start_s;
        const PlacementSearch search(study, options.noise_index, candidates, searched, alpha);
        scopes = search.scopes();
        answer.scopes.clear();
        for (const PlacementScope& scope : scopes)
            answer.scopes.push_back(search.answer(scope, options.runners_up));
        refuse_empty(search, scopes, answer.scopes);
        if (!options.resolve_to_N) break;
        const double left_N = min_resolved_N(answer.scopes);
        char text[120];
        std::snprintf(text, sizeof text, "%d repetitions: some layout may still be better by %.4f N",
                      blocks.repetitions(), left_N);
        progress(text);
        if (left_N <= *options.resolve_to_N || 2 * blocks.repetitions() > options.max_repetitions) break;
    }

    const double fresh_start_s = wall_time_s();
    CandidateList chosen{*subsets, methods, std::vector<std::uint8_t>(candidates.count(), 0)};
    for (std::size_t k = 0; k < scopes.size(); ++k) {
        for (const int reference : scopes[k].references()) chosen.wanted[reference] = 1;
        for (CountAnswer& count : answer.scopes[k].counts) {
            for_each_layout(count, [&](JudgedLayout& layout) { chosen.wanted[layout.candidate] = 1; });
        }
    }
    ScoredDraws fresh(study, options.noise_index, fresh_draws, chosen, plan.placement.objective);
    fresh.extend(blocks.count, blocks.size, weights, options.jobs);
    for (std::size_t k = 0; k < scopes.size(); ++k) {
        for (CountAnswer& count : answer.scopes[k].counts) judge_afresh(scopes[k], fresh.scenarios(), count);
        answer.scopes[k].recommended_count =
            count_where_gain_flattens(answer.scopes[k].counts, plan.worthwhile_gain_N);
    }
    answer.times.fresh_s = wall_time_s() - fresh_start_s;
    answer.noise = plan.noise_levels[options.noise_index].label;
    answer.layouts = subsets->count() - 1;
    answer.candidates = answer.layouts * static_cast<int>(methods.size());
    answer.repetitions = blocks.repetitions();
    answer.times.wall_s = wall_time_s() - start_s;
    return answer;
}

}  // namespace capstan
