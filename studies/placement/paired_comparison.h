#pragma once

#include <vector>

#include "capstan/placement/candidate_scores.h"

namespace capstan {

/// How a candidate differs from the recommended one on the same draws.
struct PairedDifference {
    int candidate = 0;
    double difference_N = 0.0;  ///< candidate - recommended
    double low_N = 0.0;         ///< simultaneous 95% interval
    double high_N = 0.0;
};

/// Differences of `others` from `recommended`, from block means: Student's t with Bonferroni's correction, so
/// that all intervals hold together with at least 95%. An interval is unbounded with fewer than two blocks.
std::vector<PairedDifference> simultaneous_differences(const std::vector<Score>& scores, int recommended,
                                                       const std::vector<int>& others);

}  // namespace capstan
