#pragma once

#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan::test {

/// Solves one step without any trick: every vector of segment directions in {-1, 0, 1}^N in turn, as a dense
/// linear system, each checked node by node with the consistent rules. A segment between two moving sides
/// need not slide (E7 by bisection, E8). Shares nothing with the engine but the equations E1-E8. Returns the
/// distinct states that verify, `tolerance_N` apart or more; several of them may.
std::vector<CableState> all_verified_states(const Cable& cable, const CableState& before,
                                            const EndConditions& ends, double tolerance_N);

}  // namespace capstan::test
