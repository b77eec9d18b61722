#include "capstan/placement/paired_comparison.h"

#include <boost/math/distributions/students_t.hpp>
#include <limits>

#include "capstan/placement/cell_statistics.h"

namespace capstan {

namespace {

// Half width in standard errors of each of `count` two-sided intervals that hold together with 1 - alpha.
double bonferroni_t(int blocks, int count, double alpha) {
    if (blocks < 2) return std::numeric_limits<double>::infinity();
    const boost::math::students_t distribution(blocks - 1);
    return boost::math::quantile(complement(distribution, alpha / (2.0 * count)));
}

}  // namespace

double simultaneous_reach_N(std::span<const double> block_value_N, int count, double alpha) {
    const double standard_error_N = mean_and_error(block_value_N).standard_error;
    const double half_width = bonferroni_t(static_cast<int>(block_value_N.size()), count, alpha);
    // Two sets that give the same estimates differ by nothing; a single block tells nothing of the spread.
    if (block_value_N.size() < 2) return half_width;
    return standard_error_N == 0.0 ? 0.0 : half_width * standard_error_N;
}

std::vector<PairedDifference> simultaneous_differences(const std::vector<Score>& scores, int recommended,
                                                       const std::vector<int>& others, double alpha) {
    std::vector<PairedDifference> differences;
    if (others.empty()) return differences;
    const Score& reference = scores[recommended];
    const int blocks = static_cast<int>(reference.block_objective_N.size());
    const int count = static_cast<int>(others.size());
    std::vector<double> difference_N(blocks);
    for (const int other : others) {
        for (int b = 0; b < blocks; ++b) {
            difference_N[b] = scores[other].block_objective_N[b] - reference.block_objective_N[b];
        }
        const double mean_N = scores[other].objective_N - reference.objective_N;
        const double reach_N = simultaneous_reach_N(difference_N, count, alpha);
        differences.push_back({other, mean_N, mean_N - reach_N, mean_N + reach_N});
    }
    return differences;
}

}  // namespace capstan
