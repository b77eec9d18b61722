#include "capstan/search/subset_scores.h"

#include <algorithm>
#include <cmath>

#include "capstan/placement/repetition_blocks.h"
#include "capstan/placement/repetition_profiles.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/platform/work_meter.h"
#include "capstan/search/subset_curves.h"
#include "capstan/search/subset_means.h"

namespace capstan {

namespace {

// What of a repetition's node errors counts: weights that sum to one.
std::vector<double> node_fractions(PlacementObjective objective, int nodes) {
    std::vector<double> fraction(padded_nodes(nodes), 0.0);
    switch (objective) {
        case PlacementObjective::load_end:
            fraction[nodes - 1] = 1.0;
            break;
        case PlacementObjective::all_nodes:
        case PlacementObjective::worst_node:
        case PlacementObjective::quantile_95:
            std::fill(fraction.begin(), fraction.begin() + nodes, 1.0 / nodes);
            break;
    }
    return fraction;
}

int width_of(PlacementObjective objective, int nodes) {
    return objective == PlacementObjective::worst_node ? nodes : 1;
}

bool is_quantile(PlacementObjective objective) {
    return objective == PlacementObjective::quantile_95;
}

}  // namespace

double work_of_draw(std::uint32_t first_draw) {
    return first_draw == 0 ? 1.0 : 0.2;  // on independent draws only the chosen layouts are scored
}

DrawBlocks DrawBlocks::for_repetitions(int repetitions) {
    return {repetitions, RepetitionBlocks{repetitions}.block_size()};
}

void score_blocks(const ScoringTask& task, const SolvedReadings& solved, int first_block, int jobs,
                  BlockErrors& errors) {
    const PreparedScenario& scenario = task.study.scenarios[task.point.scenario_index];
    const int nodes = task.study.nodes();
    const auto candidates = static_cast<std::size_t>(task.candidates.count());
    const std::vector<double> fraction = node_fractions(task.objective, nodes);
    const ErrorMeasure measure{scenario.truth.tension_N, fraction, width_of(task.objective, nodes)};
    const CurveLikelihood likelihood(scenario.curve,
                                     task.study.plan.noise_levels[task.point.noise_index].level);
    errors.width = measure.width;
    const std::size_t row = candidates * errors.width;
    errors.sum_N.resize(task.blocks.count() * row, 0.0);
    if (is_quantile(task.objective)) errors.quantile_of.resize(task.blocks.repetitions * candidates);

    parallel_for_each_index(task.blocks.count() - first_block, jobs, [&](int later) {
        const int block = first_block + later;
        RepetitionProfiles profiles(scenario, nodes);
        SubsetMeans means(task.candidates, task.weight, measure);
        SubsetCurves curves(task.candidates, scenario.curve, likelihood, measure);
        std::vector<double> error_N(row);
        double* const sum_N = errors.sum_N.data() + block * row;
        for (int r = task.blocks.first(block); r < task.blocks.end(block); ++r) {
            profiles.fill(solved, r);
            means.score(profiles.unknown(), error_N);
            curves.score({solved.reading_N.data() + solved.at(r, 0), static_cast<std::size_t>(nodes)},
                         error_N);
            for (std::size_t k = 0; k < row; ++k) sum_N[k] += error_N[k];
            note_work(work_of_draw(task.point.first_draw));
            if (is_quantile(task.objective)) {
                std::copy(error_N.begin(), error_N.end(), errors.quantile_of.begin() + r * candidates);
            }
        }
    });
}

double block_error_bytes(double candidates, PlacementObjective objective, const DrawBlocks& blocks,
                         int nodes) {
    const double sums = sizeof(double) * candidates * blocks.count() * width_of(objective, nodes);
    const double each = is_quantile(objective) ? sizeof(float) * candidates * blocks.repetitions : 0.0;
    return sums + each;
}

}  // namespace capstan
