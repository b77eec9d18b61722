#include "capstan/placement/intervals.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace capstan {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

MeanAndError mean_and_error(std::span<const double> values) {
    const double count = static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) sum += value;
    const double mean = sum / count;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return {mean, values.size() > 1 ? std::sqrt(squares / (count - 1.0) / count) : 0.0};
}

Score difference_of(Score own, const Score& reference) {
    own.objective_N -= reference.objective_N;
    for (std::size_t b = 0; b < own.block_objective_N.size(); ++b) {
        own.block_objective_N[b] -= reference.block_objective_N[b];
    }
    return own;
}

IntervalEstimate interval_of(const Score& score) {
    const std::vector<double>& block_N = score.block_objective_N;
    if (block_N.size() < 2) return {score.objective_N, -infinity, infinity};
    const boost::math::students_t distribution(static_cast<double>(block_N.size()) - 1.0);
    const double reach_N =
        boost::math::quantile(distribution, 0.975) * mean_and_error(block_N).standard_error;
    return {score.objective_N, score.objective_N - reach_N, score.objective_N + reach_N};
}

SimultaneousIntervals::SimultaneousIntervals(std::size_t blocks, std::size_t count, double alpha)
    : half_width_(infinity) {
    if (blocks < 2) return;
    const boost::math::students_t distribution(static_cast<double>(blocks) - 1.0);
    half_width_ = boost::math::quantile(complement(distribution, alpha / (2.0 * static_cast<double>(count))));
}

IntervalEstimate SimultaneousIntervals::of(const Score& score) const {
    const double standard_error_N = mean_and_error(score.block_objective_N).standard_error;
    // Two candidates with the same estimates do not differ at all; a single block shows no spread.
    double reach_N = infinity;
    if (score.block_objective_N.size() > 1) {
        reach_N = standard_error_N == 0.0 ? 0.0 : half_width_ * standard_error_N;
    }
    return {score.objective_N, score.objective_N - reach_N, score.objective_N + reach_N};
}

std::vector<PairedDifference> simultaneous_differences(const std::vector<Score>& scores, int reference,
                                                       const std::vector<int>& others, double alpha) {
    std::vector<PairedDifference> differences;
    const SimultaneousIntervals intervals(scores[reference].block_objective_N.size(),
                                          std::max<std::size_t>(others.size(), 1), alpha);
    for (const int other : others) {
        differences.push_back({other, intervals.of(difference_of(scores[other], scores[reference]))});
    }
    return differences;
}

}  // namespace capstan
