#pragma once

#include "capstan/effects/effect_row.h"

namespace capstan {

/// Lost motion between a pulley and what it is fixed to (E29): no torque while they are less than half the
/// gap apart. A single cable only pulls and keeps the joint on one side of the gap, so that the gap only
/// shifts the motor's angle.
struct Backlash {
    /// Stiffness of the closed contact: far above any cable's.
    static constexpr double contact_Nm_per_rad = 5e3;

    double motor_half_gap_rad = 0.0;
    double load_half_gap_rad = 0.0;

    /// The part of an angle across the joint that loads the contact.
    static double beyond_gap_rad(double angle_rad, double half_gap_rad) {
        return angle_rad > half_gap_rad    ? angle_rad - half_gap_rad
               : angle_rad < -half_gap_rad ? angle_rad + half_gap_rad
                                           : 0.0;
    }

    static std::vector<EffectRow<Backlash>> rows() {
        return {{.about = {.name = "backlash",
                           .variant = "motor",
                           .title = "backlash",
                           .family = "lost motion",
                           .component = "motor",
                           .end = "motor",
                           .equation = "E29",
                           .meaning = "lost motion between motor and motor pulley",
                           .needs_pair = true},
                 .parameters = {{{.name = "half_gap", .unit = "rad", .high = 1.0, .typical = 0.01},
                                 &Backlash::motor_half_gap_rad}}},
                {.about = {.name = "backlash",
                           .variant = "load",
                           .title = "backlash",
                           .family = "lost motion",
                           .component = "load_pulley",
                           .end = "load",
                           .equation = "E29",
                           .meaning = "lost motion between load pulley and handle",
                           .needs_pair = true},
                 .parameters = {{{.name = "half_gap", .unit = "rad", .high = 1.0, .typical = 0.005},
                                 &Backlash::load_half_gap_rad}}}};
    }
};

}  // namespace capstan
