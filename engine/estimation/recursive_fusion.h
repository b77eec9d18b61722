#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capstan/estimation/fusion_method.h"
#include "capstan/estimation/single_sensor.h"

namespace capstan {

/// A reading at a node, as the paper's estimators take it.
struct NodeReading {
    int node = 0;
    double value_N = 0.0;
};

/// The paper's estimators over time: every step starts from the step before's own fused estimate, as a device
/// would have to, not from the true state as in the paper's Sec. III.C. With one sensor this is its
/// single-sensor estimate. Displacements are fused as tensions are, and the median direction of the sensors
/// is the pattern that is tried first in the next step. Where no pattern verifies the complete state stays.
/// W Mean-R makes tensions too small by the weight that it leaves out; displacements are not made so.
class RecursiveFusion {
  public:
    /// `model` must outlive it. `method` must be one of the paper's that vote on an unknown direction.
    /// `weight` (nodes, any positive scale) is that of each sensor, for a method that uses weights: 1 / the
    /// error of the sensor's own estimate over time, which takes a simulation to know. Throws InvalidInput on
    /// another method, without the weights that it uses, or beyond `max_estimated_segments`.
    RecursiveFusion(const QuasiStaticStep& model, const CableState& start, const FusionMethod& method,
                    DistalSide distal_side, std::span<const double> weight = {});

    /// One sample later, from at least one reading; their nodes differ. Throws InvalidInput without any or
    /// where a node is beyond the cable. Returns how many sensors found no pattern that verifies.
    int step(double proximal_displacement_m, std::span<const NodeReading> readings);

    const CableState& estimate() const { return estimate_; }

  private:
    bool estimate_from(const EstimationProblem& problem, const NodeReading& reading);
    void fuse_displacements(FusionInput& input);
    void order_patterns();

    struct Candidate {
        DirectionPattern pattern;
        DirectionBits directions;
    };

    const QuasiStaticStep& model_;
    const FusionMethod& method_;
    CableState estimate_;
    std::vector<double> weight_;             // nodes, or empty
    std::vector<Candidate> candidates_;      // patterns
    std::vector<int> order_;                 // patterns: by distance from the previous one
    DirectionBits ordered_from_{};           // whose order that is
    std::vector<double> tension_N_;          // sensors x padded nodes
    std::vector<double> displacement_m_;     // sensors x padded nodes
    std::vector<DirectionBits> directions_;  // sensors
    std::vector<std::uint8_t> verified_;     // sensors
};

}  // namespace capstan
