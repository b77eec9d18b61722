#pragma once

#include <map>
#include <string>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// What a study at instants errs without any sensor [N]: the mean of the feasible states (E10), whose prior
/// is flat, averaged over the nodes and over a regime's instants. By the regime's name; "duty_cycle" weighs
/// the regimes. No draw is needed. Throws InvalidInput with problems_of(plan).
std::map<std::string, double> no_sensor_errors_N(const StudyPlan& plan);

}  // namespace capstan
