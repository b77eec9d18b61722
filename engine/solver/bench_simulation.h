#pragma once

#include <vector>

#include "capstan/solver/bench_cable.h"
#include "capstan/solver/pull_pull.h"

namespace capstan {

/// A bench as it is built: one cable with its far end held, or two between pulleys (E15).
struct BenchDescription {
    Cable cable;  ///< each of the pair
    bool has_second_cable = true;
    Pulleys pulleys;
    Inertia inertia;  ///< known ones; an effect's inertia comes on top
};

/// What moves the bench in one step. A torque at both pulleys moves nothing definite; a single cable's load
/// end is held at a LoadAngle.
struct BenchInputs {
    MotorInput motor;
    LoadInput load;
    double time_step_s = 0.0;
    double session_time_s = 0.0;  ///< since the session began: what drifts goes on from run to run
};

struct BenchReport {
    bool converged = true;
    int iterations = 0;
};

/// A bench over time, with the effects that the ideal model leaves out.
///
/// Node displacements and the free pulley angles solve equilibrium by Newton's method: one tridiagonal system
/// a cable (BenchCableEquations), bordered by the pulleys' torque balances. Friction has bristles (E22), by
/// default so stiff that a bench without effects agrees with PullPull to the discretisation. 2 to 4
/// iterations a step, O(nodes).
class BenchSimulation {
  public:
    /// At rest under the pretension. Throws InvalidInput if a radius is not positive.
    BenchSimulation(const BenchDescription& description, const BenchEffects& effects);
    BenchSimulation(const BenchSimulation&) = delete;
    BenchSimulation& operator=(const BenchSimulation&) = delete;

    /// Throws InvalidInput if the inputs determine no motion or are not finite; nothing has moved then.
    BenchReport advance(const BenchInputs& inputs);

    /// What the encoders and torque cells of an ideal bench would read.
    double motor_angle_rad() const { return motor_.encoder_rad; }
    double load_angle_rad() const { return load_.encoder_rad; }
    double motor_torque_Nm() const { return motor_.torque_Nm; }
    double load_torque_Nm() const { return load_.torque_Nm; }

    const BenchCable& cable_a() const { return cables_[0]; }
    const BenchCable& cable_b() const { return cables_[1]; }
    /// Between the segments' middles, where a segment's tension stands.
    double tension_at_N(const BenchCable& cable, double position_m) const;

  private:
    struct Torque {
        double value_Nm = 0.0;
        double per_rad = 0.0;
    };
    struct Pulley {
        double angle_rad = 0.0;
        double speed_rad_per_s = 0.0;
        double bristle = 0.0;
        double torque_Nm = 0.0;    // of the motor, on the load
        double encoder_rad = 0.0;  // beyond the backlash
    };
    /// How its Coulomb friction finds its sign: by bristles, which hold at rest, or by speed.
    enum class Bearing { finds_its_angle, is_turned };
    static Bearing bearing_of(bool free);
    static Torque losses(const Pulley& pulley, Bearing bearing, const PulleyFriction& friction,
                         double inertia_kg_m2, double angle_rad, double time_step_s);
    static void turn(Pulley& pulley, double angle_rad, double time_step_s);
    /// The cables' pull on both pulleys, linear in their further turns.
    struct Pull {
        EndTension motor;
        EndTension load;
    };

    struct Free {
        bool motor = false;
        bool load = false;
    };
    struct Angles {
        double motor_rad = 0.0;
        double load_rad = 0.0;
    };

    bool iterate(const BenchInputs& inputs, const Free& free, Angles& angles, int& iterations);
    bool bracket_load(const BenchInputs& inputs, const Free& free, Angles& angles, int& iterations);
    bool motor_is_free(const BenchInputs& inputs) const;
    bool load_is_free(const BenchInputs& inputs) const;
    double load_inertia_kg_m2(const BenchInputs& inputs) const;
    void begin_cables(const BenchInputs& inputs);
    Pull linearise_cables(double motor_rad, double load_rad, double session_time_s);
    Torque motor_balance(const BenchInputs& inputs, double angle_rad) const;
    Torque load_balance(const BenchInputs& inputs, double angle_rad) const;
    Torque held_by(const BenchInputs& inputs, double angle_rad) const;
    void settle(const BenchInputs& inputs, double motor_rad, double load_rad);

    BenchDescription description_;
    BenchEffects effects_;
    std::vector<double> wrap_per_load_angle_;     // nodes, empty if no bend moves
    std::vector<double> added_wrap_rad_;          // nodes
    std::vector<BenchCableEquations> equations_;  // cables
    BenchCable cables_[2];
    Pulley motor_;
    Pulley load_;
};

}  // namespace capstan
