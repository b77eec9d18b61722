#pragma once

#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

/// The cable that a chain of masses models.
struct LumpedCableNumbers {
    std::vector<CurvaturePiece> curvature;
    double axial_stiffness_N = 0.0;
    double mass_kg_per_m = 0.0;
    double dynamic_friction = 0.0;
    double static_friction = 0.0;
    double pretension_N = 0.0;
    /// Losses in the cable's material: stress = E (strain + damping d strain/dt), against
    /// oscillation between masses, and a Maxwell branch in parallel, against oscillation of the complete
    /// cable.
    double damping_s = 0.0;
    double loss_stiffness_ratio = 0.0;
    double loss_time_s = 1.0;
    bool is_cable_b = false;
    double session_start_s = 0.0;  ///< of the run
};

/// Position and speed of the two ends of a cable, positive towards the load.
struct CableEnds {
    double motor_m = 0.0;
    double motor_m_per_s = 0.0;
    double load_m = 0.0;
    double load_m_per_s = 0.0;
};

/// A cable in its sheath as a chain of masses between springs, in time: F = m a at each, Coulomb friction in
/// proportion to tension and wrap, taken exactly within a step (it stops a mass rather than reverse it).
/// Written apart from the engine's quasi-static step and with none of its code.
class LumpedCable {
  public:
    static constexpr std::size_t slip_element_count = 4;

    /// `time_step_s` must be stable: see `stable_time_step_s`.
    LumpedCable(const LumpedCableNumbers& numbers, const TrueEffects& effects, int masses,
                double time_step_s);

    /// One step: tensions from positions, speeds from tensions, positions from speeds.
    void step(const CableEnds& ends);
    /// Updates the coefficients that change slowly, after `elapsed_s`.
    void follow(double load_angle_rad, double session_time_s, double elapsed_s);

    /// At the ends, as of the last step.
    double motor_tension_N() const { return tension_N_.front(); }
    double load_tension_N() const { return tension_N_.back(); }
    double tension_N(double position_m) const;
    /// Kinetic and elastic, above the state of rest at the pretension; for linear cables.
    double energy_J(const CableEnds& ends) const;

    /// The longest step that waves along such a chain allow, with a margin.
    static double stable_time_step_s(const LumpedCableNumbers& numbers, int masses);

  private:
    void stretch_springs(const CableEnds& ends);
    void stretch_springs_with_toe(const CableEnds& ends);
    void move_masses();
    void move_masses_one_way();
    void move_masses_on_bristles();
    void move_masses_on_slip_elements();
    void update_friction(double load_angle_rad, double elapsed_s);
    void update_creep(double elapsed_s);
    void update_pretension(double session_time_s);
    void update_stiffness();
    double toe_strain(double tension_N) const;

    TrueEffects effects_;
    LumpedCableNumbers numbers_;
    int masses_;
    double spacing_m_;
    double time_step_s_;
    double speed_per_N_;  ///< the speed that a newton gives a mass in a step
    double slow_pretension_N_;
    double stiffness_ratio_ = 1.0;
    double strands_kept_in_run_ = 1.0;  // of those at its start
    bool follows_friction_ = false;

    // masses
    std::vector<double> position_m_;
    std::vector<double> speed_m_per_s_;
    std::vector<double> still_wrap_rad_;   // routing and local bends
    std::vector<double> moving_wrap_rad_;  // per radian of load angle
    std::vector<double> hold_sliding_;     // speed that friction takes in a step, per newton of tension
    std::vector<double> hold_static_;
    std::vector<double> bristle_;  // parts of full friction
    std::vector<double> slip_;     // masses x elements, parts of each one's friction
    std::vector<double> slow_speed_m_per_s_;
    std::vector<double> warmth_;
    // springs: one more than masses
    std::vector<double> tension_N_;
    std::vector<double> spring_m_;  // its unstretched length
    std::vector<double> spring_N_per_m_;
    std::vector<double> sheath_m_per_N_;
    std::vector<double> relaxed_m_;  // stretch that the Maxwell branch has forgotten
    std::vector<double> crept_m_;
    std::vector<double> crept_fast_m_;
    std::vector<double> crept_slow_m_;
    double constant_hold_m_per_s_ = 0.0;
    double viscous_factor_ = 1.0;
};

}  // namespace capstan::gap_trial
