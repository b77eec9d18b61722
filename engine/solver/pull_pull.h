#pragma once

#include <variant>

#include "capstan/solver/pull_pull_angle_search.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {

/// What moves the motor pulley.
struct MotorAngle {
    double angle_rad = 0.0;
};
struct MotorTorque {
    double torque_Nm = 0.0;
};
using MotorInput = std::variant<MotorAngle, MotorTorque>;

/// What the load pulley meets. A locked load is an angle that stays, a handle moved from outside one that
/// changes; a free load is a torque of zero.
struct LoadAngle {
    double angle_rad = 0.0;
};
/// Torque that the load takes from the transmission.
struct LoadTorque {
    double torque_Nm = 0.0;
};
/// A spring between the load pulley and a wall (or handle) that may move; relaxed where the angles are equal.
struct LoadSpring {
    double stiffness_Nm_per_rad = 0.0;
    double wall_angle_rad = 0.0;
};
using LoadInput = std::variant<LoadAngle, LoadTorque, LoadSpring>;

struct PullPullInputs {
    MotorInput motor;
    LoadInput load;
};

struct Pulleys {
    double motor_radius_m = 0.0;
    double load_radius_m = 0.0;
};

/// The pulleys unchanged. Throws InvalidInput with each radius that is not a positive length.
Pulleys checked(const Pulleys& pulleys);

/// Positive motor angle reels cable A in at the motor and lets B out; positive load angle is the way cable A
/// pulls the load pulley.
struct PullPullState {
    CableState cable_a;
    CableState cable_b;
    double motor_angle_rad = 0.0;
    double load_angle_rad = 0.0;
};

/// How a step went, beside the state that came out.
struct PullPullReport {
    StepReport cable_a;
    StepReport cable_b;
    AngleSearch motor;  ///< for a prescribed motor torque
    AngleSearch load;   ///< for a prescribed load torque or a spring

    bool solved() const { return cable_a.verified && cable_b.verified && motor.converged && load.converged; }
};

/// Two cables between a motor pulley and a load pulley, pulling against each other (E15, E16).
///
/// With both angles prescribed a step is one position-position step of each cable. A torque adds one scalar
/// root for its angle (E17); a motor torque against a spring adds two, one inside the other.
class PullPull {
  public:
    /// Throws InvalidInput if a radius is not positive.
    PullPull(const Cable& cable_a, const Cable& cable_b, const Pulleys& pulleys,
             const ModelRules& rules = ModelRules::consistent());

    /// Both cables under their pretension, both angles zero.
    PullPullState at_rest() const;

    /// Advances `state` in place. Throws InvalidInput if a number is not finite, a stiffness is negative or
    /// a torque is prescribed at both pulleys (the angles would be undetermined); `state` is then unchanged.
    PullPullReport advance(PullPullState& state, const PullPullInputs& inputs) const;
    /// The same without allocation: `workspace` is another state of this pair, and its values do not matter.
    PullPullReport advance(PullPullState& state, const PullPullInputs& inputs,
                           PullPullState& workspace) const;

    /// Torque that the motor must give; positive turns the motor pulley the positive way.
    double motor_torque_Nm(const PullPullState& state) const;
    /// Torque on the load; positive turns the load pulley the positive way.
    double load_torque_Nm(const PullPullState& state) const;
    /// Load torque, had the transmission neither friction nor inertia.
    double ideal_load_torque_Nm(double motor_torque_Nm) const {
        return pulleys_.load_radius_m / pulleys_.motor_radius_m * motor_torque_Nm;
    }

    const Cable& cable_a() const { return step_a_.cable(); }
    const Cable& cable_b() const { return step_b_.cable(); }
    const Pulleys& pulleys() const { return pulleys_; }

  private:
    struct Trial;
    void turn_to(Trial& trial, double motor_angle_rad, double load_angle_rad) const;
    void load_settles(Trial& trial, double motor_angle_rad, const LoadInput& load, double stop_at_Nm) const;
    double end_stiffness_N_per_m() const;

    QuasiStaticStep step_a_;
    QuasiStaticStep step_b_;
    Pulleys pulleys_;
    // Proximal displacements at motor angle zero.
    double rest_a_m_;
    double rest_b_m_;
};

}  // namespace capstan
