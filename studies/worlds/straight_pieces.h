#pragma once

#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// Straight conduit, by arc length from the proximal end; of a place in a bend only the place.
struct StraightPiece {
    double from_m = 0.0;
    double to_m = 0.0;

    bool operator==(const StraightPiece&) const = default;
};

/// Of each offer, where else its sensor would read the same: without a bend there is no friction (E1), so the
/// tension is the same in all of a straight piece. A sensor in a bend or at an end of the transmission, and
/// every sensor where effects of the truth act along the cable, has its own place only.
std::vector<StraightPiece> straight_pieces(const StudyPlan& plan, const std::vector<SensorOffer>& offers);

/// Of each offer, the first one with the same kind, cable and errors in the same straight piece. Sensors draw
/// their errors by their rank in a set, so two sets whose sensors agree in this number, in turn, have the
/// same readings in every world. Two sensors in one piece are not one: each has errors of its own.
std::vector<int> first_alike(const StudyPlan& plan, const std::vector<SensorOffer>& offers);

}  // namespace capstan
