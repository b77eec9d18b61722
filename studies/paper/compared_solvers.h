#pragma once

#include <functional>

#include "capstan/paper/solver_comparison.h"
#include "capstan/reference/step_problem.h"
#include "capstan/solver/end_condition.h"

namespace capstan::paper {

using Advance = std::function<reference::ReferenceReport(CableState&, const EndConditions&)>;

/// The step of a peer; nothing for the closed form, alone or of replicates.
Advance advance_of(Solver solver, const Cable& cable);

}  // namespace capstan::paper
