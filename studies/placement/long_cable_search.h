#pragma once

#include "capstan/placement/sensor_placement.h"

namespace capstan {

/// For cables whose layouts are too many to score all. For each number of sensors the best layout that greedy
/// forward choice or the D-optimal layout leads to, improved by moving single sensors by a few nodes as long
/// as that helps; the D-optimal one beside it is proven best by branch and bound, or has a gap. Answers the
/// duty cycle, and the mean over all nodes only. CountAnswer::at_most_better_N is the optimality gap: no
/// layout of that count can be better by more, if a sensor more never hurts, because it is the distance to a
/// sensor at every usable node. Throws InvalidInput for other objectives.
PlacementAnswer search_long_cable(const StudyPlan& plan, const PlacementOptions& options);

}  // namespace capstan
