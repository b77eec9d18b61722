#pragma once

#include <span>
#include <vector>

#include "capstan/placement/candidate_scores.h"

namespace capstan {

/// How a candidate differs from the recommended one on the same draws.
struct PairedDifference {
    int candidate = 0;
    double difference_N = 0.0;  ///< candidate - recommended
    double low_N = 0.0;         ///< simultaneous interval
    double high_N = 0.0;
};

/// Reach [N] to either side of a mean of block values in an interval that holds together with `count` - 1
/// others with at least 1 - `alpha`: Student's t, Bonferroni. Unbounded with fewer than two blocks.
double simultaneous_reach_N(std::span<const double> block_value_N, int count, double alpha = 0.05);

/// Differences of `others` from `recommended`, from block means: Student's t with Bonferroni's correction, so
/// that all intervals hold together with at least 1 - `alpha`. An interval is unbounded with fewer than two
/// blocks.
std::vector<PairedDifference> simultaneous_differences(const std::vector<Score>& scores, int recommended,
                                                       const std::vector<int>& others, double alpha = 0.05);

}  // namespace capstan
