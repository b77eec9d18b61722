#pragma once

#include "capstan/effects/bends.h"
#include "capstan/effects/effect_row.h"

namespace capstan {

/// Wrap angle that follows the load angle, as on a limb (E26): of both cables.
struct MovingBend {
    double extra_angle_per_load_angle = 0.0;
    double middle_m = 1.0;
    double length_m = 0.3;

    Stretch stretch() const { return stretch_around(middle_m, length_m); }

    static std::vector<EffectRow<MovingBend>> rows() {
        return {{.about = {.name = "moving_bend",
                           .title = "moving bend",
                           .family = "friction place",
                           .component = "conduit",
                           .equation = "E26",
                           .meaning = "wrap angle that follows the load angle",
                           .needs_pair = true},
                 .parameters = {{{.name = "angle_per_load_angle", .low = -20.0, .high = 20.0, .typical = 1.0},
                                 &MovingBend::extra_angle_per_load_angle},
                                {middle_of_stretch(), &MovingBend::middle_m},
                                {length_of_stretch(0.3), &MovingBend::length_m}}}};
    }
};

}  // namespace capstan
