#pragma once

#include <map>
#include <optional>
#include <string>

#include "capstan/effects/bends.h"

namespace capstan::gap_trial {

/// mu(v) = mu_d + extra exp(-|v| / speed), v low-passed with the memory.
struct TrueStribeck {
    double extra_friction = 0.0;
    double speed_m_per_s = 0.05;
    double memory_s = 0.04;
};

/// Bristles of LuGre's kind: dz/du = (1 - y (1 - softness + softness y)) / length with y = z sign(v);
/// softness 0 is LuGre's own law, 0.5 unloads as straight as Bouc and Wen's.
struct TrueBristles {
    double length_m = 0.0;  ///< 0: none
    double softness = 0.0;
};

/// mu = mu_d (N' / reference)^(exponent - 1), N' = T / R.
struct TrueLoadDependence {
    double exponent = 1.0;
    double reference_N_per_m = 10.0;
};

enum class BentCable { both, a, b };

struct TrueLocalBend {
    Stretch where;
    double angle_rad = 0.0;
    BentCable cables = BentCable::both;
};

struct TrueMovingBend {
    Stretch where;
    double angle_per_load_angle = 0.0;
};

struct TrueBearing {
    double coulomb_Nm = 0.0;
    double viscous_Nms = 0.0;
};

struct TrueCogging {
    double amplitude_Nm = 0.0;
    double periods_per_turn = 7.0;
    double phase_rad = 0.0;
};

/// strain = T / EA + toe T / (T + tension): the toe is used up as the tension grows.
struct TrueToe {
    double strain = 0.0;
    double tension_N = 10.0;
};

/// Two Kelvin-Voigt elements in series with the cable, the second three times as slow, sharing the
/// compliance 7 to 3.
struct TrueCreep {
    double ratio = 0.0;  ///< compliance of both, in parts of the cable's
    double time_constant_s = 2.0;
};

/// T0 (1 - lost (1 - exp(-t / time))) over the session.
struct TrueDrift {
    double lost = 0.0;
    double time_s = 200.0;
};

struct TrueCoupling {
    double compliance_rad_per_Nm = 0.0;  ///< 0: rigid
    double damping_Nms = 0.0;
};

/// Faults of one channel's sensor.
struct TrueSensorFault {
    double gain = 1.0;
    double offset = 0.0;
    double lag_s = 0.0;
    double delay_s = 0.0;
    double step = 0.0;
    double hysteresis = 0.0;
    // Outside the catalogue:
    double hum = 0.0;  ///< amplitude of a sine that has nothing to do with the motion
    double hum_Hz = 1.0;
    double clipped_above = 0.0;  ///< 0: not
};

// Effects outside the catalogue, for which a diagnosis has no candidate.

/// Load pulley that is not round: r (1 + fraction sin(lobes angle + phase)).
struct LobedPulley {
    double fraction = 0.0;
    double lobes = 12.0;
    double phase_rad = 0.0;
};

/// Friction that changes as sliding warms the sheath: mu (1 + gain q), q' = friction power per length /
/// heat - q / cooling time.
struct FrictionalHeating {
    double gain = 0.0;
    double heat_J_per_m = 1.0;
    double cooling_s = 30.0;
};

/// Strands of cable A that break in the middle of a session: its stiffness falls for good.
struct StrandBreak {
    double fraction = 0.0;
    double session_time_s = 0.0;
};

/// A tensioner that yields and recovers: a dip of the pretension.
struct PretensionDip {
    double fraction = 0.0;
    double session_time_s = 0.0;
    double width_s = 2.0;
};

/// Everything that a bench has and its nominal model has not. By default there is no effect.
struct TrueEffects {
    // Relative to the nominal numbers.
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;

    double viscous_drag_N_s_per_m2 = 0.0;
    double constant_drag_N_per_m = 0.0;
    TrueStribeck stribeck;
    TrueBristles bristles;
    TrueLoadDependence load_dependence;
    TrueLocalBend local_bend;
    TrueMovingBend moving_bend;
    TrueBearing motor_bearing;
    TrueBearing load_bearing;
    TrueCogging cogging;
    double extra_rotor_inertia_kg_m2 = 0.0;
    double extra_load_inertia_kg_m2 = 0.0;
    double motor_half_gap_rad = 0.0;
    double load_half_gap_rad = 0.0;
    double motor_sheath_m_per_N = 0.0;
    double load_sheath_m_per_N = 0.0;
    TrueToe toe;
    TrueCreep creep;
    TrueDrift drift;
    TrueCoupling coupling;
    std::map<std::string, TrueSensorFault> sensors;  // by channel

    double one_way_friction = 0.0;  ///< mu (1 + it) towards the load, (1 - it) towards the motor
    LobedPulley lobed_pulley;
    FrictionalHeating heating;
    StrandBreak strand_break;
    PretensionDip dip;
};

}  // namespace capstan::gap_trial
