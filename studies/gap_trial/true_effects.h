#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/effects/bends.h"

namespace capstan::gap_trial {

/// mu(v) = mu_d + extra exp(-|v| / speed), v low-passed with the memory; with a `power` (Hess and Soom 1990)
/// mu_d + extra / (1 + (|v| / speed)^power).
struct TrueStribeck {
    double extra_friction = 0.0;
    double speed_m_per_s = 0.05;
    double memory_s = 0.04;
    double power = 0.0;  ///< 0: exponential
};

/// Bristles of LuGre's kind: dz/du = (1 - y (1 - softness + softness y)) / length with y = z sign(v);
/// softness 0 is LuGre's own law, 0.5 unloads as straight as Bouc and Wen's.
struct TrueBristles {
    double length_m = 0.0;  ///< 0: none
    double softness = 0.0;
};

/// Elastic-plastic elements in parallel (Iwan 1966), each with a quarter of full friction: the first yields
/// after 0.3 lengths, the last after 2.
struct TrueSlipElements {
    double length_m = 0.0;  ///< 0: none
};

/// mu = mu_d (N' / reference)^(exponent - 1), N' = T / R.
struct TrueLoadDependence {
    double exponent = 1.0;
    double reference_N_per_m = 10.0;
};

/// A contact whose real area saturates: mu = mu_d (1 + weight (1 - n) / (1 + n)), n = N' / reference.
struct TrueSaturatingContact {
    double weight = 0.0;
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
    double second_harmonic = 0.0;  ///< as a fraction of the first; a third comes with it

    double torque_Nm(double angle_rad) const {
        constexpr double third_of_second = 0.4;
        const double phase = periods_per_turn * angle_rad + phase_rad;
        const double first_Nm = amplitude_Nm * std::sin(phase);
        return second_harmonic == 0.0
                   ? first_Nm
                   : first_Nm + second_harmonic * amplitude_Nm *
                                    (std::sin(2.0 * phase + 1.0) +
                                     third_of_second * std::sin(3.0 * phase + 2.0));
    }
};

/// strain = T / EA + toe T / (T + tension): the toe is used up as the tension grows.
struct TrueToe {
    double strain = 0.0;
    double tension_N = 10.0;
};

/// Two Kelvin-Voigt elements in series with the cable.
struct TrueCreep {
    double ratio = 0.0;            ///< compliance of both, in parts of the cable's
    double time_constant_s = 2.0;  ///< of the first
    double fast_fraction = 0.7;    ///< of the compliance, that the first has
    double slow_factor = 3.0;      ///< time constant of the second over that of the first
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
    bool lag_in_two_stages = false;  ///< of half the lag each
    double delay_s = 0.0;
    double step = 0.0;
    double hysteresis = 0.0;
    double hysteresis_spread = 0.0;  ///< two plays of (1 - it) and (1 + it) times the half width
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

/// A number that follows a condition x of the runs: by `amount` times x / scale, or times its square.
struct ConditionedNumber {
    enum class Which { friction, pretension, zero };
    Which which = Which::friction;
    std::string channel;    ///< of a zero
    std::string condition;  ///< such as "roll_deg"
    double amount = 0.0;    ///< of a logarithm; in the channel's unit for a zero
    double scale = 1.0;
    bool squared = false;

    double change(const std::map<std::string, double>& conditions) const;
};

/// Everything that a bench has and its nominal model has not. By default it has none.
struct TrueEffects {
    // Relative to the nominal numbers.
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;

    double viscous_drag_N_s_per_m2 = 0.0;
    double constant_drag_N_per_m = 0.0;
    TrueStribeck stribeck;
    TrueBristles bristles;
    TrueSlipElements slip_elements;
    TrueLoadDependence load_dependence;
    TrueSaturatingContact saturating_contact;
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
    std::vector<ConditionedNumber> conditioned;

    /// The effects in a run under these conditions: the conditioned numbers have become ratios and zeros.
    TrueEffects under(const std::map<std::string, double>& conditions) const;

    double one_way_friction = 0.0;  ///< mu (1 + it) towards the load, (1 - it) towards the motor
    LobedPulley lobed_pulley;
    FrictionalHeating heating;
    StrandBreak strand_break;
    PretensionDip dip;
};

}  // namespace capstan::gap_trial
