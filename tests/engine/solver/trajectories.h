#pragma once

#include <utility>
#include <vector>

#include "capstan/solver/quasi_static_step.h"

namespace capstan::test {

/// The proximal end on a sine about its rest, the distal end locked.
std::vector<EndConditions> sine_against_locked_end(const Cable& cable, double amplitude_m,
                                                   int samples_per_cycle, int samples);

/// Displacements [m] of both ends from their rest: smooth, incommensurate, each step at most about `step_m`.
std::vector<std::pair<double, double>> both_ends_wander(int samples, double step_m, unsigned seed);

}  // namespace capstan::test
