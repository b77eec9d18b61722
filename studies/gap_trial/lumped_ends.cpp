#include "capstan/gap_trial/lumped_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace capstan::gap_trial {

namespace {

// Of the nominal rotor inertia, where lost motion parts the pulley from the rotor.
constexpr double pulley_fraction = 0.3;
// Flanks that meet: stiff against the cables, soft enough for the time step.
constexpr double motor_flank_Nm_per_rad = 300.0;
constexpr double motor_flank_Nms = 5e-3;
constexpr double load_flank_Nm_per_rad = 3000.0;
constexpr double load_flank_Nms = 0.2;
// A bearing whose angle is prescribed reaches its friction over this.
constexpr double bearing_bristle_rad = 3e-4;

double beyond_gap(double angle_rad, double half_gap_rad) {
    return angle_rad - std::clamp(angle_rad, -half_gap_rad, half_gap_rad);
}

// Speed after Coulomb friction that would stop it, but not turn it round.
double slowed(double speed, double most) {
    return speed - std::clamp(speed, -most, most);
}

}  // namespace

MotorSide::MotorSide(double nominal_inertia_kg_m2, const TrueEffects& effects, double time_step_s)
    : bearing_(effects.motor_bearing),
      cogging_(effects.cogging),
      half_gap_rad_(effects.motor_half_gap_rad),
      rotor_kg_m2_(nominal_inertia_kg_m2 + effects.extra_rotor_inertia_kg_m2),
      pulley_kg_m2_(pulley_fraction * nominal_inertia_kg_m2),
      time_step_s_(time_step_s) {
    if (half_gap_rad_ > 0.0) rotor_kg_m2_ -= pulley_kg_m2_;
}

void MotorSide::step(double motor_torque_Nm, double cable_torque_Nm) {
    double drive_Nm = motor_torque_Nm;
    if (cogging_.amplitude_Nm != 0.0) drive_Nm -= cogging_.torque_Nm(rotor_rad_);
    if (half_gap_rad_ > 0.0) {
        step_with_lost_motion(drive_Nm, cable_torque_Nm);
        return;
    }
    const double per_Nm = time_step_s_ / rotor_kg_m2_;
    const double free =
        (rotor_rad_per_s_ + per_Nm * (drive_Nm - cable_torque_Nm)) / (1.0 + per_Nm * bearing_.viscous_Nms);
    rotor_rad_per_s_ = slowed(free, per_Nm * bearing_.coulomb_Nm);
    rotor_rad_ += time_step_s_ * rotor_rad_per_s_;
    pulley_rad_ = rotor_rad_;
    pulley_rad_per_s_ = rotor_rad_per_s_;
}

void MotorSide::step_with_lost_motion(double drive_Nm, double cable_torque_Nm) {
    const double flank_Nm = flank_torque_Nm();
    rotor_rad_per_s_ += time_step_s_ / rotor_kg_m2_ * (drive_Nm - flank_Nm);
    rotor_rad_ += time_step_s_ * rotor_rad_per_s_;
    move_pulley(flank_Nm, cable_torque_Nm);
}

double MotorSide::flank_torque_Nm() const {
    const double pressed_rad = beyond_gap(rotor_rad_ - pulley_rad_, half_gap_rad_);
    double flank_Nm = motor_flank_Nm_per_rad * pressed_rad;
    if (pressed_rad != 0.0) flank_Nm += motor_flank_Nms * (rotor_rad_per_s_ - pulley_rad_per_s_);
    return flank_Nm * pressed_rad < 0.0 ? 0.0 : flank_Nm;  // flanks push, they do not pull
}

void MotorSide::move_pulley(double flank_Nm, double cable_torque_Nm) {
    const double pulley_per_Nm = time_step_s_ / pulley_kg_m2_;
    const double free = (pulley_rad_per_s_ + pulley_per_Nm * (flank_Nm - cable_torque_Nm)) /
                        (1.0 + pulley_per_Nm * bearing_.viscous_Nms);
    pulley_rad_per_s_ = slowed(free, pulley_per_Nm * bearing_.coulomb_Nm);
    pulley_rad_ += time_step_s_ * pulley_rad_per_s_;
}

double MotorSide::step_prescribed(const MotionBetweenSamples::Point& rotor, double cable_torque_Nm) {
    rotor_rad_ = rotor.value;
    rotor_rad_per_s_ = rotor.speed;
    double torque_Nm = rotor_kg_m2_ * rotor.acceleration;
    if (cogging_.amplitude_Nm != 0.0) torque_Nm += cogging_.torque_Nm(rotor_rad_);
    if (half_gap_rad_ > 0.0) {
        const double flank_Nm = flank_torque_Nm();
        move_pulley(flank_Nm, cable_torque_Nm);
        return torque_Nm + flank_Nm;
    }
    pulley_rad_ = rotor_rad_;
    pulley_rad_per_s_ = rotor_rad_per_s_;
    bristle_ = std::clamp(bristle_ + time_step_s_ * rotor_rad_per_s_ / bearing_bristle_rad, -1.0, 1.0);
    return torque_Nm + cable_torque_Nm + bearing_.coulomb_Nm * bristle_ +
           bearing_.viscous_Nms * rotor_rad_per_s_;
}

LoadSide::LoadSide(double nominal_inertia_kg_m2, const TrueEffects& effects, double time_step_s)
    : bearing_(effects.load_bearing),
      half_gap_rad_(effects.load_half_gap_rad),
      is_rigid_(effects.load_half_gap_rad == 0.0 && effects.coupling.compliance_rad_per_Nm == 0.0),
      stiffness_Nm_per_rad_(effects.coupling.compliance_rad_per_Nm > 0.0
                                ? 1.0 / effects.coupling.compliance_rad_per_Nm
                                : load_flank_Nm_per_rad),
      damping_Nms_(effects.coupling.compliance_rad_per_Nm > 0.0 ? effects.coupling.damping_Nms
                                                                : load_flank_Nms),
      inertia_kg_m2_(nominal_inertia_kg_m2 + effects.extra_load_inertia_kg_m2),
      time_step_s_(time_step_s) {}

double LoadSide::bearing_torque_Nm() {
    if (bearing_.coulomb_Nm == 0.0 && bearing_.viscous_Nms == 0.0) return 0.0;
    bristle_ = std::clamp(bristle_ + time_step_s_ * pulley_rad_per_s_ / bearing_bristle_rad, -1.0, 1.0);
    return bearing_.coulomb_Nm * bristle_ + bearing_.viscous_Nms * pulley_rad_per_s_;
}

void LoadSide::step_against(double resisting_Nm, double cable_torque_Nm) {
    torque_Nm_ = resisting_Nm;
    const double per_Nm = time_step_s_ / inertia_kg_m2_;
    const double free = (pulley_rad_per_s_ + per_Nm * (cable_torque_Nm - resisting_Nm)) /
                        (1.0 + per_Nm * bearing_.viscous_Nms);
    pulley_rad_per_s_ = slowed(free, per_Nm * bearing_.coulomb_Nm);
    pulley_rad_ += time_step_s_ * pulley_rad_per_s_;
}

void LoadSide::step(const MotionBetweenSamples::Point& hand, double cable_torque_Nm) {
    if (is_rigid_) {
        pulley_rad_ = hand.value;
        pulley_rad_per_s_ = hand.speed;
        torque_Nm_ = cable_torque_Nm - inertia_kg_m2_ * hand.acceleration - bearing_torque_Nm();
        return;
    }
    const double pressed_rad = beyond_gap(pulley_rad_ - hand.value, half_gap_rad_);
    torque_Nm_ = stiffness_Nm_per_rad_ * pressed_rad;
    if (pressed_rad != 0.0 || half_gap_rad_ == 0.0)
        torque_Nm_ += damping_Nms_ * (pulley_rad_per_s_ - hand.speed);
    if (half_gap_rad_ > 0.0 && torque_Nm_ * pressed_rad < 0.0) torque_Nm_ = 0.0;
    pulley_rad_per_s_ += time_step_s_ / inertia_kg_m2_ * (cable_torque_Nm - torque_Nm_ - bearing_torque_Nm());
    pulley_rad_ += time_step_s_ * pulley_rad_per_s_;
}

}  // namespace capstan::gap_trial
