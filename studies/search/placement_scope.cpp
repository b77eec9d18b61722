#include "capstan/search/placement_scope.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/placement/cell_statistics.h"

namespace capstan {

namespace {

constexpr double judged_quantile = 0.95;

double sum_over_blocks(const BlockErrors& errors, std::size_t row, std::size_t slot, int blocks) {
    double sum_N = 0.0;
    for (int b = 0; b < blocks; ++b) sum_N += errors.sum_N[b * row + slot];
    return sum_N;
}

// Of the numbers that belong to a candidate, the one with the largest sum over all repetitions.
std::size_t worst_slot(const BlockErrors& errors, std::size_t row, std::size_t first, int blocks) {
    std::size_t worst = first;
    double worst_N = -1.0;
    for (std::size_t slot = first; slot < first + errors.width; ++slot) {
        const double sum_N = sum_over_blocks(errors, row, slot, blocks);
        if (sum_N > worst_N) {
            worst = slot;
            worst_N = sum_N;
        }
    }
    return worst;
}

// The quantile q of all repetitions; block values q + (fraction above q - 5%) / density at q.
void summarise_quantile(const BlockErrors& errors, std::size_t candidates, std::size_t candidate,
                        const DrawBlocks& blocks, ScenarioErrors& result) {
    const int repetitions = blocks.repetitions;
    std::vector<double> error_N(repetitions);
    for (int r = 0; r < repetitions; ++r) error_N[r] = errors.quantile_of[r * candidates + candidate];
    std::vector<double> sorted_N = error_N;
    const double q_N = quantile(sorted_N, judged_quantile);
    // Density from the spacing around the quantile, as wide as the square root of its distance to the end
    // asks for (Bofinger's n^-1/5 rule gives about this at a few thousand repetitions).
    const double half_fraction = std::min(0.04, 1.0 - judged_quantile - 0.5 / repetitions);
    const double spacing_N = quantile(sorted_N, judged_quantile + half_fraction) -
                             quantile(sorted_N, judged_quantile - half_fraction);
    const double per_fraction_N = spacing_N / (2.0 * half_fraction);
    result.error_N[candidate] = q_N;
    for (int b = 0; b < blocks.count(); ++b) {
        int above = 0;
        for (int r = blocks.first(b); r < blocks.end(b); ++r) above += error_N[r] > q_N;
        const double fraction_above = static_cast<double>(above) / blocks.size(b);
        result.block_error_N[candidate * blocks.count() + b] =
            q_N + (fraction_above - (1.0 - judged_quantile)) * per_fraction_N;
    }
}

}  // namespace

ScenarioErrors summarise(const BlockErrors& errors, const CandidateList& candidates,
                         PlacementObjective objective, const DrawBlocks& blocks) {
    const auto count = static_cast<std::size_t>(candidates.count());
    const std::size_t row = count * errors.width;
    ScenarioErrors result{blocks.count(), std::vector<double>(count),
                          std::vector<double>(count * blocks.count())};
    for (std::size_t c = 0; c < count; ++c) {
        if (candidates.subset(static_cast<int>(c)) == 0 || !candidates.wants(static_cast<int>(c))) {
            result.error_N[c] = std::numeric_limits<double>::infinity();
            continue;
        }
        if (objective == PlacementObjective::quantile_95) {
            summarise_quantile(errors, count, c, blocks, result);
            continue;
        }
        const std::size_t slot =
            errors.width == 1 ? c : worst_slot(errors, row, c * errors.width, blocks.count());
        result.error_N[c] = sum_over_blocks(errors, row, slot, blocks.count()) / blocks.repetitions;
        for (int b = 0; b < blocks.count(); ++b) {
            result.block_error_N[c * blocks.count() + b] = errors.sum_N[b * row + slot] / blocks.size(b);
        }
    }
    return result;
}

PlacementScope::PlacementScope(std::string name, std::string regime, std::vector<double> fraction)
    : name_(std::move(name)), regime_(std::move(regime)), fraction_{std::move(fraction)} {}

PlacementScope::PlacementScope(std::string name, std::vector<std::vector<double>> regime_fraction,
                               std::vector<int> reference)
    : name_(std::move(name)), fraction_(std::move(regime_fraction)), reference_(std::move(reference)) {}

double PlacementScope::regret_N(const std::vector<ScenarioErrors>& scenarios, int candidate,
                                std::size_t regime) const {
    double error_N = 0.0;
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
        const double fraction = fraction_[regime][s];
        if (fraction == 0.0) continue;
        error_N += fraction * scenarios[s].error_N[candidate];
        if (!reference_.empty()) error_N -= fraction * scenarios[s].error_N[reference_[regime]];
    }
    return error_N;
}

std::size_t PlacementScope::worst_regime(const std::vector<ScenarioErrors>& scenarios, int candidate) const {
    std::size_t worst = 0;
    for (std::size_t regime = 1; regime < fraction_.size(); ++regime) {
        if (regret_N(scenarios, candidate, regime) > regret_N(scenarios, candidate, worst)) worst = regime;
    }
    return worst;
}

double PlacementScope::objective_N(const std::vector<ScenarioErrors>& scenarios, int candidate) const {
    return regret_N(scenarios, candidate, worst_regime(scenarios, candidate));
}

Score PlacementScope::score(const std::vector<ScenarioErrors>& scenarios, int candidate) const {
    const std::size_t regime = worst_regime(scenarios, candidate);
    Score score{regret_N(scenarios, candidate, regime), std::vector<double>(scenarios.front().blocks, 0.0)};
    std::vector<double>& value_N = score.block_objective_N;
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
        const double fraction = fraction_[regime][s];
        if (fraction == 0.0) continue;
        const auto own_N = scenarios[s].blocks_of(candidate);
        for (std::size_t b = 0; b < value_N.size(); ++b) value_N[b] += fraction * own_N[b];
        if (reference_.empty()) continue;
        const auto reference_N = scenarios[s].blocks_of(reference_[regime]);
        for (std::size_t b = 0; b < value_N.size(); ++b) value_N[b] -= fraction * reference_N[b];
    }
    return score;
}

}  // namespace capstan
