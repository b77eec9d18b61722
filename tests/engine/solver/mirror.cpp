#include "mirror.h"

#include <algorithm>

#include "capstan/cable/cable_cut.h"

namespace capstan::test {

namespace {

// a u + b T = c with u = -u' and T = T'; a position keeps its factor of 1.
EndCondition mirrored(const EndCondition& end) {
    return end.tension_factor == 0.0 ? EndCondition{end.displacement_factor, 0.0, -end.value}
                                     : EndCondition{-end.displacement_factor, end.tension_factor, end.value};
}

}  // namespace

CableSpecification mirrored(const CableSpecification& specification) {
    CableSpecification other = specification;
    std::reverse(other.curvature.begin(), other.curvature.end());
    std::reverse(other.node_places_m.begin(), other.node_places_m.end());
    for (double& place_m : other.node_places_m) place_m = length_m(specification.curvature) - place_m;
    return other;
}

EndConditions mirrored(const EndConditions& ends) {
    return {mirrored(ends.distal), mirrored(ends.proximal)};
}

MotionPattern mirrored(const MotionPattern& pattern) {
    MotionPattern other = pattern;
    other.proximal_direction = opposite(pattern.distal_direction);
    other.distal_direction = opposite(pattern.proximal_direction);
    std::swap(other.proximal_moving_nodes, other.distal_moving_nodes);
    if (pattern.kind == MotionKind::opposed) {
        other.zero_velocity_fraction = 1.0 - pattern.zero_velocity_fraction;
    }
    return other;
}

CableState mirrored(const CableState& state) {
    CableState other{{state.tension_N.rbegin(), state.tension_N.rend()}, {}, mirrored(state.last_motion)};
    for (auto u = state.displacement_m.rbegin(); u != state.displacement_m.rend(); ++u) {
        other.displacement_m.push_back(-*u);
    }
    return other;
}

}  // namespace capstan::test
