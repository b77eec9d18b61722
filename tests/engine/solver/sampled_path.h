#pragma once

#include <functional>
#include <vector>

#include "capstan/solver/quasi_static_step.h"

namespace capstan::test {

/// How far both ends have moved from their rest.
struct EndMotion {
    double proximal_m = 0.0;
    double distal_m = 0.0;
};

/// A motion in time, which runs from 0 to 1, and the cable's states at some instants of it.
struct SampledPath {
    std::function<EndMotion(double time)> motion;
    int instants = 0;  // at which the states are kept, evenly spaced

    std::vector<CableState> states(const Cable& cable, int steps_per_instant) const;
};

/// Pulled out, smoothly and without turning.
EndMotion pulled(double time);
/// The proximal end goes through one and a quarter cycles, the distal end is locked.
EndMotion one_end_cycles(double time);
/// Both ends do, out of step; at times against each other with no node at rest.
EndMotion both_ends_cycle(double time);

}  // namespace capstan::test
