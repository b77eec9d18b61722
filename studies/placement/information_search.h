#pragma once

#include <vector>

#include "capstan/placement/information_choice.h"
#include "capstan/plan/placement_constraints.h"

namespace capstan {

/// The layout of a number of sensors whose readings tell most, and how sure that is.
struct MostInformative {
    std::vector<int> nodes;  // from 0, rising; empty: no layout satisfies the constraints
    double nats = 0.0;
    double at_most_nats = 0.0;  ///< no layout of that count tells more; equal to nats: proven best

    bool is_proven() const { return at_most_nats <= nats; }
};

/// What a layout tells on average over scenarios: `share` sum to one, scenarios.
struct AverageInformation {
    std::vector<SetInformation> scenarios;
    std::vector<double> fraction;  // scenarios
};

/// Branch and bound over the allowed layouts of `sensors` sensors (D-optimal). Half a log determinant of I
/// plus a covariance never loses by a sensor, and a sensor adds the less the more there are (it is
/// submodular), so what a partial layout tells plus the largest single gains that are left bounds all that it
/// can become. At most `max_branches` partial layouts are looked at, however fast the machine; a search that
/// ends there still has a valid bound.
MostInformative max_information_layout(const AverageInformation& information,
                                       const PlacementConstraints& constraints, int sensors,
                                       long max_branches = 200000);

}  // namespace capstan
