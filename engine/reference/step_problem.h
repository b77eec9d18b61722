#pragma once

#include <cmath>
#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"

namespace capstan::reference {

/// Rounding of displacements of up to a metre, with three digits to spare (E5).
inline constexpr double displacement_rounding_m = 1e-12;

/// What does not change from step to step, worked out here anew: the reference solvers share the equations
/// with the closed-form step (engine/README.md, consistent rules) and none of its code.
struct CableConstants {
    explicit CableConstants(const Cable& cable);

    int segments() const { return static_cast<int>(sliding_exponent.size()); }
    int nodes() const { return segments() + 1; }

    double half_compliance_m_per_N;          ///< h of E2 and E3, of a segment of mean length
    std::vector<double> relative_length;     // segments
    std::vector<double> sliding_exponent;    // segments: mu_d times wrap angle
    std::vector<double> breakaway_exponent;  // segments: mu_s times wrap angle
    std::vector<double> sliding_ratio;       // segments: exp(sliding_exponent)
    std::vector<double> breakaway_ratio;     // segments: exp(breakaway_exponent)
};

inline CableConstants::CableConstants(const Cable& cable)
    : half_compliance_m_per_N(0.5 * cable.mean_segment_compliance_m_per_N()),
      relative_length(cable.relative_length().begin(), cable.relative_length().end()) {
    for (const double angle_rad : cable.wrap_angle_rad()) {
        sliding_exponent.push_back(cable.dynamic_friction() * angle_rad);
        breakaway_exponent.push_back(cable.static_friction() * angle_rad);
        sliding_ratio.push_back(std::exp(sliding_exponent.back()));
        breakaway_ratio.push_back(std::exp(breakaway_exponent.back()));
    }
}

/// One step to be solved.
struct StepProblem {
    const CableConstants& cable;
    const CableState& before;
    const EndConditions& ends;

    int segments() const { return cable.segments(); }
    int nodes() const { return cable.nodes(); }
    /// The segment slid in the step before, so that mu_d holds it and not mu_s (E4).
    bool slid(int segment) const {
        return segment_direction(before.last_motion, segment, segments()) != Direction::none;
    }
};

/// How a reference solver fared.
struct ReferenceReport {
    bool converged = false;   ///< if not, the state is the one before the step
    double residual_N = 0.0;  ///< root finder: largest residual; linear solvers: not measured, 0
    int iterations = 0;       ///< root finder: iterations; linear solvers: systems solved
};

}  // namespace capstan::reference
