#pragma once

#include <vector>

#include "capstan/plan/placement_constraints.h"
#include "capstan/search/information_choice.h"

namespace capstan {

/// The layout of a number of sensors with the most information, and a bound on any other.
struct MostInformative {
    std::vector<int> nodes;  // from 0, rising; empty: no layout satisfies the constraints
    double nats = 0.0;
    double at_most_nats = 0.0;  ///< no layout of that count has more; equal to nats: proven best
};

/// The information of a layout, averaged over scenarios with weights that sum to one.
struct AverageInformation {
    std::vector<SetInformation> scenarios;
    std::vector<double> fraction;  // scenarios
};

/// Branch and bound over the allowed layouts of `sensors` sensors (D-optimal). Half the log determinant of I
/// plus a covariance is monotone and submodular: a sensor never lowers it, and adds less the more sensors
/// there are. So the information of a partial layout plus the largest remaining single gains bounds that of
/// every layout that contains it. At most `max_branches` partial layouts are examined, independent of the
/// machine's speed; a search that ends there still has a valid bound.
MostInformative max_information_layout(const AverageInformation& information,
                                       const PlacementConstraints& constraints, int sensors,
                                       long max_branches = 200000);

}  // namespace capstan
