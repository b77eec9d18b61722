#pragma once

#include <optional>

#include "capstan/effects/bench_effects.h"
#include "capstan/solver/pull_pull.h"

namespace capstan {

/// What moves a bench in one step. A torque at both pulleys determines no motion; a single cable's load
/// end is held at a LoadAngle.
struct BenchInputs {
    MotorInput motor;
    LoadInput load;
    double time_step_s = 0.0;
    double session_time_s = 0.0;  ///< since the session began: what drifts goes on from run to run
    /// The acceleration of an angle that is given, where it is known (E35). Otherwise it is the change of the
    /// speed since the step before, which is late by a step.
    std::optional<double> motor_rad_per_s2{};
    std::optional<double> load_rad_per_s2{};
};

/// What is read of a torque that is 0. A prescribed torque is a reading: what acts is the reading less this.
struct TorqueZeros {
    double motor_Nm = 0.0;
    double load_Nm = 0.0;
};

/// Torques at a pulley that the cables pull with a torque, linear in the pulley's angle and in that torque.
struct PulleyTorque {
    double value_Nm = 0.0;
    double per_rad = 0.0;  ///< while the cables' torque stays
    double per_pull = 0.0;
};

struct PulleyAngles {
    double motor_rad = 0.0;
    double load_rad = 0.0;
};

/// The two pulleys of one bench, what turns and holds them, and what they lose: bearings, cogging, inertia,
/// lost motion, the hand or lock at the load (E17, E27 to E29, E34, E35).
class BenchPulleys {
  public:
    /// `known`: inertia of the nominal bench; the effect's comes on top.
    BenchPulleys(const Pulleys& pulleys, const BenchEffects& effects, const Inertia& known,
                 const TorqueZeros& zeros)
        : pulleys_(pulleys), effects_(effects), known_(known), zeros_(zeros) {}

    /// At rest a single cable pulls.
    void rest(double motor_torque_Nm, double load_torque_Nm) {
        motor_.torque_Nm = motor_torque_Nm;
        load_.torque_Nm = load_torque_Nm;
    }

    /// Whether the pulley finds its angle in equilibrium; else it is where the input says.
    bool motor_is_free(const BenchInputs& inputs) const;
    bool load_is_free(const BenchInputs& inputs) const;
    /// Where a step begins its search.
    PulleyAngles start(const BenchInputs& inputs) const;
    PulleyAngles angles() const { return {motor_.angle_rad, load_.angle_rad}; }

    /// What the motor must give where the cables pull with this torque, less what it gives.
    PulleyTorque motor_balance(const BenchInputs& inputs, double angle_rad, double pull_Nm) const;
    /// What the load pulley passes on of the cables' torque: all but its losses, less what is taken.
    PulleyTorque load_balance(const BenchInputs& inputs, double angle_rad, double pull_Nm) const;

    /// Remembers a step's outcome and reads the instruments. Pulls: of cable A less that of cable B [N].
    void settle(const BenchInputs& inputs, const PulleyAngles& angles, double motor_pull_N,
                double load_pull_N);

    /// What the encoders and torque cells of an ideal bench would read.
    double motor_angle_rad() const { return motor_.encoder_rad; }
    double load_angle_rad() const { return load_.encoder_rad; }
    double motor_torque_Nm() const { return motor_.torque_Nm; }
    double load_torque_Nm() const { return load_.torque_Nm; }

  private:
    /// How an inertia that rings on its cables moves: Newmark's method, which keeps the ringing that a
    /// backward difference would damp away.
    struct Swing {
        double speed_rad_per_s = 0.0;
        double acceleration_rad_per_s2 = 0.0;
    };
    struct Pulley {
        double angle_rad = 0.0;
        double speed_rad_per_s = 0.0;
        Swing swing;
        double bristle = 0.0;
        double torque_Nm = 0.0;    // of the motor, on the load
        double encoder_rad = 0.0;  // beyond the backlash
    };
    /// How its Coulomb friction finds its sign: by bristles, which hold at rest, or by speed.
    enum class Bearing { finds_its_angle, is_turned };
    static Bearing bearing_of(bool free, const BearingFriction& friction);
    static PulleyTorque losses(const Pulley& pulley, Bearing bearing, const BearingFriction& friction,
                               const Torque& of_inertia, double angle_rad, double pull_Nm,
                               double time_step_s);
    static Torque inertia_torque(const Pulley& pulley, double inertia_kg_m2, double angle_rad,
                                 double time_step_s, const std::optional<double>& known_rad_per_s2);
    PulleyTorque motor_losses(const BenchInputs& inputs, double angle_rad, double pull_Nm) const;
    static void turn(Pulley& pulley, const BearingFriction& friction, double angle_rad, double time_step_s);
    static Swing swung(const Pulley& pulley, double angle_rad, double time_step_s);
    Torque swing_torque(const BenchInputs& inputs, double angle_rad) const;
    double load_inertia_kg_m2(const BenchInputs& inputs) const;
    Torque held_by(const BenchInputs& inputs, double angle_rad) const;
    double motor_stands_rad(double torque_Nm, double angle_rad) const;

    Pulleys pulleys_;
    BenchEffects effects_;
    Inertia known_;
    TorqueZeros zeros_;
    Pulley motor_;
    Pulley load_;
};

}  // namespace capstan
