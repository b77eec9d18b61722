#pragma once

#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/cable/motion_pattern.h"

namespace capstan {

/// Tension and displacement at every node, and the motion that led there (friction remembers it).
/// Displacements are positive towards the distal end, so u[i + 1] - u[i] is elongation.
struct CableState {
    std::vector<double> tension_N;       // nodes
    std::vector<double> displacement_m;  // nodes
    MotionPattern last_motion;
};

/// The cable at rest under its pretension, distal end at displacement 0: u_i = -T0 (L - x_i) / EA.
inline CableState pretensioned(const Cable& cable) {
    CableState state;
    state.tension_N.assign(cable.nodes(), cable.pretension_N());
    state.displacement_m.resize(cable.nodes());
    const double strain = cable.pretension_N() / cable.axial_stiffness_N();
    for (int node = 0; node < cable.nodes(); ++node) {
        state.displacement_m[node] =
            -strain * cable.mean_segment_length_m() * (cable.segments() - cable.relative_position()[node]);
    }
    return state;
}

}  // namespace capstan
