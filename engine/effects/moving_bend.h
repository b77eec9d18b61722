#pragma once

#include "capstan/effects/bends.h"

namespace capstan {

/// Wrap angle that follows the load angle, as on a limb (E26): of both cables.
struct MovingBend {
    Stretch stretch;
    double extra_angle_per_load_angle = 0.0;
};

}  // namespace capstan
