#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan::sensitivity {

/// A number that nobody knows exactly, as a factor on what the configuration says.
struct UncertainParameter {
    std::string name;   ///< "friction", ... as in [sensitivity]
    std::string title;  ///< for people
    std::string unit;   ///< of value(); empty: none
    std::vector<double> (*range)(const SensitivityPlan&);
    /// What the factor acts on: the dynamic friction coefficient, the wrap angle, ...
    double (*value)(const StudyPlan&, int noise_index);
    void (*scale)(StudyPlan&, int noise_index, double ratio);
};

/// Friction, curvature, stiffness, pretension, noise.
const std::vector<UncertainParameter>& uncertain_parameters();

/// The plan with each parameter scaled; `ratio` is one factor for each of uncertain_parameters(). An instant
/// that is then no longer in its regime is replaced by the nearest sample that is; a regime that never occurs
/// is left out and its duty share given to the others. Nothing if none is left.
std::optional<StudyPlan> plan_with(const StudyPlan& plan, int noise_index, const std::vector<double>& ratio);

}  // namespace capstan::sensitivity
