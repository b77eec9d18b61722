#pragma once

#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// A set of sensors that could be bought.
struct Candidate {
    std::vector<int>
        sensors;  ///< indices of the question's offers, rising; empty: the motor's position alone
    std::vector<std::string> names;  ///< of the named sets that it is: "even", "distal", "both", ...
    double price = 0.0;

    int count() const { return static_cast<int>(sensors.size()); }
};

/// The candidates of a plan: the named sets, or all sets that [placement] allows, by price and then by place.
/// The first one has no sensor; constraints do not apply to it. Throws InvalidInput where no other set is
/// allowed or there are more than `max_candidates`.
std::vector<Candidate> candidates_of(const StudyPlan& plan, const std::vector<SensorOffer>& offers);

inline constexpr std::size_t max_candidates = 200000;

/// "tension at 0.2 and 1.2 m, an encoder at the load", "no sensor".
std::string words_of(const Candidate& candidate, const std::vector<SensorOffer>& offers);

}  // namespace capstan
