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
CableState pretensioned(const Cable& cable);

}  // namespace capstan
