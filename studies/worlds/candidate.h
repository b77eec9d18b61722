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
    /// All usable sensors together, allowed or not: of a greedy search what no set can beat. It is not for
    /// sale.
    bool is_bound = false;

    int count() const { return static_cast<int>(sensors.size()); }
};

/// The candidates of a plan, by price and then by place: the named sets, or all sets that [placement] allows.
/// Of more than `max_candidates`, or with search = "greedy", only the named sets, the single sensors, a set
/// that has what is required, and at the end the bound; search_greedily() adds others. The first one has no
/// sensor; constraints do not apply to it. Throws InvalidInput where no other set is allowed.
std::vector<Candidate> candidates_of(const StudyPlan& plan, const std::vector<SensorOffer>& offers);

inline constexpr std::size_t max_candidates = 200000;

/// Of all sensors (indices of `offers`) together.
double price_of(const std::vector<int>& sensors, const std::vector<SensorOffer>& offers);

/// "tension at 0.2 and 1.2 m, an encoder at the load", "no sensor".
std::string words_of(const Candidate& candidate, const std::vector<SensorOffer>& offers);

}  // namespace capstan
