#pragma once

#include <string>
#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/solver/end_condition.h"

namespace capstan::test {

/// A path of both ends, and the kind of motion that it is there for.
struct Motion {
    std::string name;
    double static_friction = 0.0;
    std::vector<EndConditions> path;  // steps
};

/// The paper's Sec. III.B cable: Table I with 40 N of preload.
Cable preloaded_cable(int segments, double static_friction);

/// Every pair of inputs and kind of motion, with mu_s equal to mu_d and with Table I's.
std::vector<Motion> all_motions(int steps);

}  // namespace capstan::test
