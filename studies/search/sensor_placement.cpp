#include "capstan/search/sensor_placement.h"

#include <algorithm>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/work_meter.h"
#include "capstan/search/placement_search.h"

namespace capstan {

namespace {

// Above this many nodes times layouts an exact search takes many minutes.
constexpr double max_scored_nodes = 1.2e6;

// Above this the scores of all candidates do not fit into the memory that a study may take.
constexpr double max_score_bytes = 600.0 * 1024 * 1024;

std::vector<const FusionMethod*> fusable_methods(const PreparedStudy& study) {
    std::vector<const FusionMethod*> methods;
    for (const FusionMethod* method : study.methods) {
        if (method->knowledge != Knowledge::direction_known) methods.push_back(method);
    }
    return methods;
}

double score_bytes(const PreparedStudy& study, int nodes, int max_sensors, std::size_t methods) {
    const double candidates = SensorSubsets::how_many(nodes, max_sensors) * static_cast<double>(methods);
    const DrawBlocks blocks = DrawBlocks::for_repetitions(study.plan.repetitions);
    const double kept = sizeof(double) * candidates * (blocks.count() + 1.0);
    return static_cast<double>(study.scenarios.size()) *
           (kept + block_error_bytes(candidates, study.plan.placement.objective, blocks, study.nodes()));
}

// All sets of nodes if they fit, so that every family is among them; else those that the constraints allow.
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

void judge_again(const PlacementScope& scope, const std::vector<ScenarioErrors>& independent,
                 CountAnswer& count) {
    const Score best = scope.score(independent, count.optimum.candidate);
    for_each_layout(count, [&](JudgedLayout& layout) {
        const Score own = scope.score(independent, layout.candidate);
        layout.independent = interval_of(own);
        layout.difference = interval_of(difference_of(own, best));
    });
    count.optimism_N = count.optimum.independent.value_N - count.optimum.searched_N;
}

// Throws if layouts are allowed but none satisfies the limit on the error after a loss.
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

void ScopeAnswer::recommend_count(double worthwhile_gain_N) {
    std::vector<CountError> by_count;
    for (const CountAnswer& count : counts)
        by_count.push_back({count.sensors, count.optimum.independent.value_N});
    recommended_count = count_where_gain_flattens(by_count, worthwhile_gain_N);
}

PlacementAnswer place_sensors(const StudyPlan& plan, const PlacementOptions& options) {
    const double start_s = wall_time_s();
    const auto progress = [&](const std::string& message) {
        if (options.on_progress) options.on_progress(message);
    };
    const PreparedStudy study = prepare(plan);
    const std::vector<const FusionMethod*> methods = fusable_methods(study);
    if (methods.empty()) {
        throw InvalidInput(
            {"estimation.methods: all methods named need the true direction; name one "
             "that does not, such as \"posterior_mean\", or \"all\""});
    }
    const std::optional<SensorSubsets> subsets = all_subsets(study, methods.size());
    if (!subsets) return search_long_cable(plan, options);

    CandidateList candidates{*subsets, methods, {}};
    const auto weights = ScoredDraws::weights(study, options.noise_index, options.jobs);
    ScoredDraws searched(study, options.noise_index, 0, candidates, plan.placement.objective);
    DrawBlocks blocks = DrawBlocks::for_repetitions(plan.repetitions);
    if (options.resolve_to_N) blocks = blocks.filled_up();
    PlacementAnswer answer;
    std::vector<PlacementScope> scopes;
    // Each look at the draws has half the error probability of the one before: together they keep 95%.
    double alpha = options.resolve_to_N ? 0.025 : 0.05;
    for (;; alpha /= 2.0, blocks = blocks.doubled()) {
        const double score_start_s = wall_time_s();
        expect_work((work_of_draw(0) + work_of_draw(independent_draws)) *
                    static_cast<double>(study.scenarios.size()) *
                    (blocks.repetitions - searched.blocks().repetitions));
        searched.extend(blocks, weights, options.jobs);
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
                      blocks.repetitions, left_N);
        progress(text);
        if (left_N <= *options.resolve_to_N || 2 * blocks.repetitions > options.max_repetitions) break;
    }

    const double independent_start_s = wall_time_s();
    CandidateList chosen{*subsets, methods, std::vector<std::uint8_t>(candidates.count(), 0)};
    for (std::size_t k = 0; k < scopes.size(); ++k) {
        for (const int reference : scopes[k].references()) chosen.wanted[reference] = 1;
        for (CountAnswer& count : answer.scopes[k].counts) {
            for_each_layout(count, [&](JudgedLayout& layout) { chosen.wanted[layout.candidate] = 1; });
        }
    }
    ScoredDraws independent(study, options.noise_index, independent_draws, chosen, plan.placement.objective);
    independent.extend(blocks, weights, options.jobs);
    for (std::size_t k = 0; k < scopes.size(); ++k) {
        for (CountAnswer& count : answer.scopes[k].counts)
            judge_again(scopes[k], independent.scenarios(), count);
        answer.scopes[k].recommend_count(plan.worthwhile_gain_N);
    }
    answer.times.independent_s = wall_time_s() - independent_start_s;
    answer.noise = plan.noise_levels[options.noise_index].label;
    answer.layouts = subsets->count() - 1;
    answer.candidates = answer.layouts * static_cast<int>(methods.size());
    answer.repetitions = blocks.repetitions;
    answer.times.wall_s = wall_time_s() - start_s;
    return answer;
}

}  // namespace capstan
