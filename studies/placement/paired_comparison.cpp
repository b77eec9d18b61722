#include "capstan/placement/paired_comparison.h"

#include <boost/math/distributions/students_t.hpp>
#include <limits>

#include "capstan/placement/cell_statistics.h"

namespace capstan {

namespace {

// Half width in standard errors of each of `count` two-sided intervals that hold together with 95%.
double bonferroni_t(int blocks, int count) {
    if (blocks < 2) return std::numeric_limits<double>::infinity();
    const boost::math::students_t distribution(blocks - 1);
    return boost::math::quantile(complement(distribution, 0.05 / (2.0 * count)));
}

}  // namespace

std::vector<PairedDifference> simultaneous_differences(const std::vector<Score>& scores, int recommended,
                                                       const std::vector<int>& others) {
    std::vector<PairedDifference> differences;
    if (others.empty()) return differences;
    const Score& reference = scores[recommended];
    const int blocks = static_cast<int>(reference.block_objective_N.size());
    const double half_width = bonferroni_t(blocks, static_cast<int>(others.size()));
    std::vector<double> difference_N(blocks);
    for (const int other : others) {
        for (int b = 0; b < blocks; ++b) {
            difference_N[b] = scores[other].block_objective_N[b] - reference.block_objective_N[b];
        }
        const double standard_error_N = mean_and_error(difference_N).standard_error;
        const double mean_N = scores[other].objective_N - reference.objective_N;
        // Two sets that give the same estimates differ by nothing; a single block tells nothing of the
        // spread.
        const bool identical = blocks > 1 && standard_error_N == 0.0;
        const double reach_N = identical ? 0.0 : blocks > 1 ? half_width * standard_error_N : half_width;
        differences.push_back({other, mean_N, mean_N - reach_N, mean_N + reach_N});
    }
    return differences;
}

}  // namespace capstan
