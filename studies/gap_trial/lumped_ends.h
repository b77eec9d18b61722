#pragma once

#include "capstan/gap_trial/motion_between_samples.h"
#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

/// Rotor, motor pulley and what is between them, moved by a torque. Positive: reels cable A in.
class MotorSide {
  public:
    MotorSide(double nominal_inertia_kg_m2, const TrueEffects& effects, double time_step_s);

    void step(double motor_torque_Nm, double cable_torque_Nm);
    double pulley_rad() const { return pulley_rad_; }
    double pulley_rad_per_s() const { return pulley_rad_per_s_; }
    /// What the encoder on the rotor sees.
    double rotor_rad() const { return rotor_rad_; }

  private:
    void step_with_lost_motion(double drive_Nm, double cable_torque_Nm);

    TrueBearing bearing_;
    TrueCogging cogging_;
    double half_gap_rad_;
    double rotor_kg_m2_;  // with the pulley, where they are one
    double pulley_kg_m2_;
    double time_step_s_;
    double rotor_rad_ = 0.0;
    double rotor_rad_per_s_ = 0.0;
    double pulley_rad_ = 0.0;
    double pulley_rad_per_s_ = 0.0;
};

/// Load pulley and what ties it to the hand or the lock. Positive: the way cable A pulls.
class LoadSide {
  public:
    LoadSide(double nominal_inertia_kg_m2, const TrueEffects& effects, double time_step_s);

    void step(const MotionBetweenSamples::Point& hand, double cable_torque_Nm);
    double pulley_rad() const { return pulley_rad_; }
    double pulley_rad_per_s() const { return pulley_rad_per_s_; }
    /// What the load cell between pulley and hand feels.
    double torque_Nm() const { return torque_Nm_; }

  private:
    double bearing_torque_Nm();

    TrueBearing bearing_;
    double half_gap_rad_;
    bool is_rigid_;
    double stiffness_Nm_per_rad_;
    double damping_Nms_;
    double inertia_kg_m2_;
    double time_step_s_;
    double bristle_ = 0.0;  // of the bearing, in parts of its Coulomb friction
    double pulley_rad_ = 0.0;
    double pulley_rad_per_s_ = 0.0;
    double torque_Nm_ = 0.0;
};

}  // namespace capstan::gap_trial
