#pragma once

#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/paper/solver_comparison.h"
#include "capstan/solver/end_condition.h"

namespace capstan::paper {

inline constexpr int steps_per_cycle = 1000;

/// Table I with the preload of Sec. III.B.
Cable preloaded_cable(int segments);

/// What the ends of that cable do, step by step.
std::vector<EndConditions> cycle_of(const Cable& cable, ComparedMotion motion);

}  // namespace capstan::paper
