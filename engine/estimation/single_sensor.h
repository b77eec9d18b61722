#pragma once

#include <optional>
#include <span>
#include <vector>

#include "capstan/estimation/direction_pattern.h"
#include "capstan/estimation/estimation_problem.h"

namespace capstan {

/// The estimate that one pattern gives from a reading z at one node: every tension is intercept + slope * z,
/// and the pattern verifies (E4, E5) for low_N < z < high_N, because every check is linear in z.
struct SensorBranch {
    DirectionBits directions{};
    bool verified = true;  ///< false: no pattern verifies, and this is the previous state instead
    double low_N = 0.0;
    double high_N = 0.0;
    std::vector<double> intercept_N;  // nodes
    std::vector<double> slope;        // nodes

    double tension_N(int node, double reading_N) const { return intercept_N[node] + slope[node] * reading_N; }
};

/// Whether an estimate may let the distal end set a side of its own in motion (E3 on both sides, the reading
/// on the distal one). The paper's experiment blocks the output, and its figures come out only without.
enum class DistalSide { excluded, admitted };

/// In which order patterns are tried; the first that verifies counts. The paper does not say it.
enum class PatternOrder {
    nearest_first,   ///< by Hamming distance from the previous pattern
    farthest_first,  ///< the reverse, to see what the order does
};

/// State estimation from one reading and the proximal displacement, direction unknown (paper Sec. II.C).
///
/// The first pattern that verifies is the estimate: the previous one, then the others by Hamming distance
/// from it. A reading at a moving node takes the place of the boundary condition E3; a pattern in which the
/// sensor's node rests would leave the reading unused, so it is not a candidate. When none verifies the
/// estimate is the previous state.
class SingleSensorEstimator {
  public:
    /// Throws InvalidInput beyond `max_estimated_segments`.
    SingleSensorEstimator(const EstimationProblem& problem, DistalSide distal_side,
                          PatternOrder order = PatternOrder::nearest_first);

    struct Choice {
        int branch = 0;              ///< index into branches(sensor)
        int verifying_patterns = 0;  ///< 0: unverified; more than one: ambiguous
    };
    Choice choose(int sensor, double reading_N) const;

    /// The sensor's branches in order of preference; the last one is the unverified fallback.
    std::span<const SensorBranch> branches(int sensor) const { return branches_[sensor]; }
    int nodes() const { return static_cast<int>(branches_.size()); }

  private:
    std::vector<std::vector<SensorBranch>> branches_;  // nodes
};

/// The estimate under the true pattern. Empty if the sensor's node rests under it: its reading says nothing.
/// `truth` may be any pattern of the step, also one with the zero-velocity point inside a segment.
std::optional<SensorBranch> known_direction_branch(const EstimationProblem& problem,
                                                   const MotionPattern& truth, int sensor);

}  // namespace capstan
