#pragma once

#include "capstan/effects/bends.h"

namespace capstan {

enum class BentCables { both, only_a, only_b };

/// A tight bend that the routing does not show (E25): extra wrap angle over a short stretch.
struct LocalBend {
    Stretch stretch;
    double extra_angle_rad = 0.0;
    BentCables cables = BentCables::both;
};

}  // namespace capstan
