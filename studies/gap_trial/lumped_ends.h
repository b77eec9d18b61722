#pragma once

#include <algorithm>
#include <vector>

#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

/// A motion between its fine samples: cubic, with the slopes of central differences.
class MotionBetweenSamples {
  public:
    MotionBetweenSamples(const std::vector<double>& samples, double rate_Hz)
        : samples_(samples), rate_Hz_(rate_Hz) {}

    struct Point {
        double value = 0.0;
        double speed = 0.0;
        double acceleration = 0.0;
    };

    /// `fraction` (0 to 1) of the way from `sample` to the next.
    Point at(std::size_t sample, double fraction) const {
        const double here = value(sample);
        const double next = value(sample + 1);
        const double slope = half_difference(sample);
        const double next_slope = half_difference(sample + 1);
        const double rise = next - here;
        const double c = 3.0 * rise - 2.0 * slope - next_slope;
        const double d = slope + next_slope - 2.0 * rise;
        const double s = fraction;
        return {here + s * (slope + s * (c + s * d)), rate_Hz_ * (slope + s * (2.0 * c + 3.0 * s * d)),
                rate_Hz_ * rate_Hz_ *
                    ((1.0 - s) * second_difference(sample) + s * second_difference(sample + 1))};
    }

  private:
    double value(std::size_t sample) const { return samples_[std::min(sample, samples_.size() - 1)]; }
    double half_difference(std::size_t sample) const {
        return sample == 0 ? 0.0 : 0.5 * (value(sample + 1) - value(sample - 1));
    }
    double second_difference(std::size_t sample) const {
        return sample == 0 ? 0.0 : value(sample + 1) - 2.0 * value(sample) + value(sample - 1);
    }

    const std::vector<double>& samples_;
    double rate_Hz_;
};

/// Rotor, motor pulley and what is between them, moved by a torque. Positive: reels cable A in.
class MotorSide {
  public:
    MotorSide(double nominal_inertia_kg_m2, const TrueEffects& effects, double time_step_s);

    void step(double motor_torque_Nm, double cable_torque_Nm);
    /// The same where a stiff servo prescribes the rotor's motion; returns the torque that this takes.
    double step_prescribed(const MotionBetweenSamples::Point& rotor, double cable_torque_Nm);
    double pulley_rad() const { return pulley_rad_; }
    double pulley_rad_per_s() const { return pulley_rad_per_s_; }
    /// What the encoder on the rotor sees.
    double rotor_rad() const { return rotor_rad_; }

  private:
    void step_with_lost_motion(double drive_Nm, double cable_torque_Nm);
    double flank_torque_Nm() const;
    void move_pulley(double flank_Nm, double cable_torque_Nm);

    TrueBearing bearing_;
    TrueCogging cogging_;
    double half_gap_rad_;
    double rotor_kg_m2_;  // with the pulley, where they are one
    double pulley_kg_m2_;
    double time_step_s_;
    double rotor_rad_ = 0.0;
    double rotor_rad_per_s_ = 0.0;
    double bristle_ = 0.0;  // of the bearing of a prescribed rotor, in parts of its Coulomb friction
    double pulley_rad_ = 0.0;
    double pulley_rad_per_s_ = 0.0;
};

/// Load pulley and what ties it to the hand or the lock. Positive: the way cable A pulls.
class LoadSide {
  public:
    LoadSide(double nominal_inertia_kg_m2, const TrueEffects& effects, double time_step_s);

    void step(const MotionBetweenSamples::Point& hand, double cable_torque_Nm);
    /// The same where a load motor resists with a torque, and the pulley finds its own angle.
    void step_against(double resisting_Nm, double cable_torque_Nm);
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
