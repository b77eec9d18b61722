#pragma once

#include <cmath>

#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"
#include "capstan/effects/presliding.h"

namespace capstan {

/// Friction at a pulley (E27): Coulomb, in proportion to the torque that passes, and viscous.
struct BearingFriction {
    double coulomb_Nm = 0.0;
    double viscous_Nm_s = 0.0;
    /// Coulomb friction in parts of the torque between cables and pulley: that of gears and of teeth under
    /// load. Below 1, where a drive locks itself.
    double per_torque = 0.0;
    /// Angle over which Coulomb friction builds up, as bristles do, so that it holds at rest. 0: friction of
    /// a pulley whose angle is prescribed fades below 0.01 rad/s, a pulley that finds its own angle has 1e-4.
    double presliding_rad = 0.0;

    Bristle<double> bristle_after(double bend, double turned_rad) const {
        constexpr double default_rad = 1e-4;  // as the cable's, at a radius of some centimetres
        return laws::bristle_after<double>({presliding_rad > 0.0 ? presliding_rad : default_rad, 0.0}, bend,
                                           turned_rad);
    }
    /// The sign of the motion by its speed, and its slope with the angle.
    static Bristle<double> sign_of(double speed_rad_per_s, double time_step_s) {
        constexpr double fading_rad_per_s = 0.01;
        const double sign = std::tanh(speed_rad_per_s / fading_rad_per_s);
        return {sign, (1.0 - sign * sign) / (fading_rad_per_s * time_step_s)};
    }
    /// Without what is in proportion to the torque. `sign`: of the motion, from the bristles or the speed;
    /// `speed_per_rad`: how the speed goes with the angle [1/s].
    Torque torque(const Bristle<double>& sign, double speed_rad_per_s, double speed_per_rad) const {
        return {coulomb_Nm * sign.bend + viscous_Nm_s * speed_rad_per_s,
                coulomb_Nm * sign.bend_per_m + viscous_Nm_s * speed_per_rad};
    }
};

struct PulleyFriction {
    BearingFriction motor;
    BearingFriction load;

    static std::vector<EffectRow<PulleyFriction>> rows() {
        const EffectDescription at_load = {
            .name = "pulley_friction",
            .variant = "load",
            .title = "pulley friction",
            .family = "end friction",
            .component = "load_pulley",
            .end = "load",
            .equation = "E27",
            .meaning = "friction of the load pulley's bearing, which fades at rest",
            .needs_pair = true};
        EffectDescription at_motor = at_load;
        at_motor.variant = at_motor.component = at_motor.end = "motor";
        at_motor.meaning = "friction of the motor pulley's bearing";
        at_motor.needs_pair = false;
        EffectDescription holding = at_load;
        holding.variant = "load holding";
        holding.meaning = "friction of the load pulley's bearing, which holds at rest";
        const EffectParameter per_torque = {.name = "per_torque", .high = 0.9, .typical = 0.05};
        EffectDescription of_motor_gear = at_motor;
        EffectDescription of_load_gear = at_load;
        of_motor_gear.variant = "motor gear";
        of_motor_gear.is_rare = of_load_gear.is_rare = true;
        of_motor_gear.meaning = "friction at the motor in proportion to the torque that passes, as of a gear";
        of_load_gear.variant = "load gear";
        of_load_gear.meaning = "friction at the load in proportion to the torque that passes, as of a gear";
        const EffectRow<PulleyFriction>::Parameter coulomb = {
            {.name = "coulomb", .unit = "N m", .high = 10.0, .typical = 0.05},
            [](PulleyFriction& friction) -> double& { return friction.load.coulomb_Nm; }};
        const EffectRow<PulleyFriction>::Parameter viscous = {
            {.name = "viscous", .unit = "N m s", .high = 10.0, .typical = 1e-2},
            [](PulleyFriction& friction) -> double& { return friction.load.viscous_Nm_s; }};
        return {
            {.about = at_motor,
             .parameters = {{{.name = "coulomb", .unit = "N m", .high = 10.0, .typical = 0.01},
                             [](PulleyFriction& f) -> double& { return f.motor.coulomb_Nm; }},
                            {{.name = "viscous", .unit = "N m s", .high = 10.0, .typical = 1e-3},
                             [](PulleyFriction& f) -> double& { return f.motor.viscous_Nm_s; }}}},
            {.about = at_load, .parameters = {coulomb, viscous}},
            {.about = holding,
             .parameters = {coulomb,
                            viscous,
                            {{.name = "presliding",
                              .unit = "rad",
                              .low = 1e-5,
                              .high = 0.1,
                              .typical = 2e-4,
                              .role = ParameterRole::shape,
                              .absent = 2e-4},
                             [](PulleyFriction& f) -> double& { return f.load.presliding_rad; }}}},
            {.about = of_motor_gear,
             .parameters = {{per_torque, [](PulleyFriction& f) -> double& { return f.motor.per_torque; }}}},
            {.about = of_load_gear,
             .parameters = {{per_torque, [](PulleyFriction& f) -> double& { return f.load.per_torque; }}}}};
    }
};

}  // namespace capstan
