#pragma once

#include <span>
#include <vector>

namespace capstan {

struct MeanAndError {
    double mean = 0.0;
    double standard_error = 0.0;
};

/// Mean of independent values and the standard error of that mean.
MeanAndError mean_and_error(std::span<const double> values);

/// How good a candidate is by one question; smaller is better.
struct Score {
    double objective_N = 0.0;
    /// blocks: the objective is, to first order, their mean. A block has the same repetitions in every
    /// scenario, so the spread between blocks contains what scenarios share (a sensor's bias).
    std::vector<double> block_objective_N;
};

/// `own` - `reference`, block by block, on the same draws.
Score difference_of(Score own, const Score& reference);

/// An estimate and its 95% interval.
struct IntervalEstimate {
    double value_N = 0.0;
    double low_N = 0.0;
    double high_N = 0.0;
};

/// The interval of a single estimate: Student's t on the block values. Unbounded with fewer than two blocks.
IntervalEstimate interval_of(const Score& score);

/// Intervals of `count` estimates that all hold together with at least 1 - `alpha`: Student's t on the block
/// values with Bonferroni's correction. Unbounded with fewer than two blocks.
class SimultaneousIntervals {
  public:
    SimultaneousIntervals(std::size_t blocks, std::size_t count, double alpha);

    IntervalEstimate of(const Score& score) const;

  private:
    double half_width_;  // in standard errors
};

/// How a candidate differs from the reference on the same draws.
struct PairedDifference {
    int candidate = 0;
    IntervalEstimate difference;  ///< candidate - reference, simultaneous
};

/// Differences of `others` from `reference`; all intervals hold together with at least 1 - `alpha`.
std::vector<PairedDifference> simultaneous_differences(const std::vector<Score>& scores, int reference,
                                                       const std::vector<int>& others, double alpha = 0.05);

}  // namespace capstan
