#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "capstan/placement/placement_answer.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

struct PlacementOptions {
    int jobs = 0;         ///< threads; 0: all processors
    int noise_index = 0;  ///< which of the plan's noise levels
    int runners_up = 3;   ///< to each count
    /// Repetitions are added until, with 95% certainty, no candidate is better than the optimum of its count
    /// by more than this [N]; nothing: the plan's repetitions only.
    std::optional<double> resolve_to_N;
    int max_repetitions = 128000;  ///< where that stops in any case
    std::function<void(const std::string&)> on_progress;
};

/// Scores every set of sensors with every fusion method of the plan on the same draws and finds, for each
/// number of sensors and each question, the best that the constraints allow, then judges it on fresh draws.
/// Throws InvalidInput with what is wrong with the plan, or if no layout satisfies the constraints.
PlacementAnswer place_sensors(const StudyPlan& plan, const PlacementOptions& options);

}  // namespace capstan
