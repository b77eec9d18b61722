#pragma once

#include <array>

#include "capstan/ensemble/far_end_process.h"
#include "capstan/ensemble/rate_friction.h"
#include "capstan/ensemble/uncertain_cable.h"

namespace capstan {

/// What the distal end is fastened to; what moves as FarEndMotion says is the end itself, or the spring's
/// wall.
struct FarEndSupport {
    double spring_stiffness_N_per_m = 0.0;  ///< 0: the end itself is moved
};

/// What an estimator believes before it has seen a reading.
struct CableBelief {
    CableArrangement arrangement = CableArrangement::single;
    std::array<CableFactors, 2> expected;  ///< of cable A and of cable B; log_wrap: of every bend, or empty
    CableUncertainty uncertainty;          ///< of each cable on its own
    FarEndMotion far_end;
    FarEndSupport support;
    double interval_s = 0.01;  ///< between samples
    /// Known exactly. Where it is there, mu_s counts as mu_d, as on the bench.
    RateFriction rate_friction{};
};

}  // namespace capstan
