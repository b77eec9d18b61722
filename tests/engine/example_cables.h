#pragma once

#include <random>

#include "capstan/cable/cable.h"
#include "capstan/cable/cable_cut.h"

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

inline Cable paper_cable(int segments) {
    return Cable(paper_specification(segments));
}

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

/// The same with nodes where its bends begin and end and in the middle of the second one; 12 segments.
inline CableSpecification unevenly_cut_specification() {
    CableSpecification specification = routed_specification(12);
    specification.node_places_m = bend_ends_m(specification.curvature);
    specification.node_places_m.insert(specification.node_places_m.begin() + 3, 0.925);
    return specification;
}

/// Nodes anywhere: the routed conduit with lengths of segments that differ by a factor of up to 20.
inline Cable randomly_cut_cable(int segments, double static_friction, std::mt19937_64& random) {
    CableSpecification specification = routed_specification(segments);
    specification.static_friction = static_friction;
    std::vector<double> node_m = {0.0};
    for (int segment = 0; segment < segments; ++segment)
        node_m.push_back(node_m.back() + std::uniform_real_distribution<double>(0.05, 1.0)(random));
    for (int node = 1; node < segments; ++node)
        specification.node_places_m.push_back(1.2 * node_m[node] / node_m.back());
    return Cable(specification);
}

}  // namespace capstan::test
