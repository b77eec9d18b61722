#pragma once

#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// The studies of a plan with a sweep, in order: segments, friction, curvature, stiffness, the
/// last changing fastest. Each has a name of its own, no sweep, and the seed of the plan: all share their
/// draws, so that differences between them are paired. Their config_toml is still that of the plan. A plan
/// without a sweep is its only study. Throws InvalidInput if a regime is never reached.
std::vector<StudyPlan> studies_in_sweep(const StudyPlan& plan);

}  // namespace capstan
