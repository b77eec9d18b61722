#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "capstan/plan/study_plan.h"
#include "capstan/search/placement_answer.h"

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
/// number of sensors and each question, the best that the constraints allow, then re-estimates its error on
/// independent draws. Throws InvalidInput with what is wrong with the plan, or if no layout satisfies the
/// constraints. A cable with too many layouts goes to search_long_cable().
PlacementAnswer place_sensors(const StudyPlan& plan, const PlacementOptions& options);

/// For cables whose layouts are too many to score all. For each number of sensors the best layout that greedy
/// forward choice or the D-optimal layout leads to, improved by moving single sensors by a few nodes as long
/// as that helps; the D-optimal one beside it is proven best by branch and bound, or has a gap. Answers the
/// duty cycle, and the mean over all nodes only. CountAnswer::at_most_better_N is the optimality gap: no
/// layout of that count can be better by more, provided that one more sensor never hurts, because the gap is
/// the distance to a sensor at every usable node. Throws InvalidInput for other objectives.
PlacementAnswer search_long_cable(const StudyPlan& plan, const PlacementOptions& options);

}  // namespace capstan
