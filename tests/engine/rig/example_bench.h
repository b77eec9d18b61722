#pragma once
// The bench of the paper's experiments, two metres of cable on two pulleys, as the tests of the rig use it.

#include "capstan/rig/bench_simulation.h"

namespace capstan::test {

inline constexpr double time_step_s = 0.005;
inline constexpr Pulleys pulleys{0.02, 0.104};

inline Cable cable_with(int segments, double friction = 0.21) {
    CableSpecification specification;
    specification.curvature = {{0.6, 5.0}, {0.8, 0.28}, {0.6, 5.0}};
    specification.segments = segments;
    specification.axial_stiffness_N = 4000.0;
    specification.dynamic_friction = specification.static_friction = friction;
    specification.pretension_N = 6.0;
    return Cable(specification);
}

}  // namespace capstan::test
