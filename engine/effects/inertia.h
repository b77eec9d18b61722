#pragma once

#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Moments of inertia that the quasi-static model leaves out (E35): of rotor and motor pulley, of load pulley
/// and handle.
struct Inertia {
    double motor_kg_m2 = 0.0;
    double load_kg_m2 = 0.0;
    /// How fast the ringing of a rotor on its cables loses speed beside their friction: by eddy currents in
    /// the motor, and in the cables' material.
    double motor_decay_per_s = 0.0;

    /// Implicit Euler.
    static Torque torque(double inertia_kg_m2, double speed_rad_per_s, double speed_before_rad_per_s,
                         double time_step_s) {
        return {inertia_kg_m2 * (speed_rad_per_s - speed_before_rad_per_s) / time_step_s,
                inertia_kg_m2 / (time_step_s * time_step_s)};
    }

    static std::vector<EffectRow<Inertia>> rows() {
        return {{.about = {.name = "inertia",
                           .variant = "motor",
                           .title = "unmodelled inertia",
                           .family = "actuator",
                           .component = "motor",
                           .end = "motor",
                           .equation = "E35",
                           .meaning = "inertia of rotor and motor pulley"},
                 .parameters =
                     {{{.name = "inertia", .unit = "kg m2", .high = 10.0, .typical = 1e-4, .resonates = true},
                       &Inertia::motor_kg_m2},
                      // What loses its speed faster does not ring; friction stops it.
                      {{.name = "decay", .unit = "1/s", .high = 20.0, .typical = 3.0, .is_detail = true},
                       &Inertia::motor_decay_per_s}}},
                {.about = {.name = "inertia",
                           .variant = "load",
                           .title = "unmodelled inertia",
                           .family = "actuator",
                           .component = "load_pulley",
                           .end = "load",
                           .equation = "E35",
                           .meaning = "inertia of load pulley and handle",
                           .needs_pair = true},
                 .parameters = {{{.name = "inertia", .unit = "kg m2", .high = 10.0, .typical = 2e-3},
                                 &Inertia::load_kg_m2}}}};
    }
};

}  // namespace capstan
