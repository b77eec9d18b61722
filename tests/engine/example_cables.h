#pragma once

#include "capstan/cable/cable.h"

namespace capstan::test {

/// The paper's Table I: 2 m of conduit bent to 0.28 m all along.
inline CableSpecification paper_specification(int segments) {
    CableSpecification specification;
    specification.curvature = {{2.0, 0.28}};
    specification.segments = segments;
    specification.axial_stiffness_N = 2000.0;
    specification.dynamic_friction = 0.21;
    specification.static_friction = 0.63;
    specification.pretension_N = 10.0;
    return specification;
}

inline Cable paper_cable(int segments) { return Cable(paper_specification(segments)); }

/// Straight pieces and two bends of different radius.
inline CableSpecification routed_specification(int segments) {
    CableSpecification specification;
    specification.curvature = {{0.3, straight}, {0.2, 0.06}, {0.3, straight}, {0.25, 0.1}, {0.15, straight}};
    specification.segments = segments;
    specification.axial_stiffness_N = 3000.0;
    specification.dynamic_friction = 0.15;
    specification.static_friction = 0.2;
    specification.pretension_N = 20.0;
    return specification;
}

}  // namespace capstan::test
