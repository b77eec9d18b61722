#include "capstan/rig/bench_pulleys.h"

#include <algorithm>
#include <cmath>

namespace capstan {

namespace {

// Newmark's method, slightly damped, so that contact does not ring on.
constexpr double newmark_damping = 0.05;
constexpr double newmark_beta = 0.25 * (1.0 + newmark_damping) * (1.0 + newmark_damping);
constexpr double newmark_gamma = 0.5 + newmark_damping;

// The speed at the end of a step, and how it goes with the angle there, by the second-order backward
// difference (E20). The mean of the step is half a step late.
struct SpeedAtEnd {
    double rad_per_s, per_rad;
};
SpeedAtEnd speed_at_end(double turned_rad, double speed_before_rad_per_s, double time_step_s) {
    return {1.5 * turned_rad / time_step_s - 0.5 * speed_before_rad_per_s, 1.5 / time_step_s};
}

}  // namespace

bool BenchPulleys::motor_is_free(const BenchInputs& inputs) const {
    return std::holds_alternative<MotorTorque>(inputs.motor) ||
           effects_.of<Backlash>().motor_half_gap_rad > 0.0;
}

bool BenchPulleys::load_is_free(const BenchInputs& inputs) const {
    return !std::holds_alternative<LoadAngle>(inputs.load) ||
           effects_.of<Backlash>().load_half_gap_rad > 0.0 ||
           effects_.of<EnvironmentCoupling>().compliance_rad_per_Nm > 0.0;
}

// A load pulley that a compliant coupling holds moves with what is held.
PulleyAngles BenchPulleys::start(const BenchInputs& inputs) const {
    const auto* held = std::get_if<LoadAngle>(&inputs.load);
    const bool follows = held != nullptr && effects_.of<Backlash>().load_half_gap_rad == 0.0;
    const double load_rad = follows ? load_.angle_rad + held->angle_rad - load_.encoder_rad : load_.angle_rad;
    return {motor_is_free(inputs) ? motor_.angle_rad : std::get<MotorAngle>(inputs.motor).angle_rad,
            load_is_free(inputs) ? load_rad : held->angle_rad};
}

// Inside a gap only its inertia holds a load pulley whose cables slide.
double BenchPulleys::load_inertia_kg_m2(const BenchInputs& inputs) const {
    constexpr double min_kg_m2 = 1e-5;
    const double sum_kg_m2 = known_.load_kg_m2 + effects_.of<Inertia>().load_kg_m2;
    return load_is_free(inputs) ? std::max(min_kg_m2, sum_kg_m2) : sum_kg_m2;
}

// The acceleration of an angle that is given may be known; that of a free pulley is the backward difference.
Torque BenchPulleys::inertia_torque(const Pulley& pulley, double inertia_kg_m2, double angle_rad,
                                    double time_step_s, const std::optional<double>& known_rad_per_s2) {
    if (known_rad_per_s2) return {inertia_kg_m2 * *known_rad_per_s2, 0.0};
    return Inertia::torque(inertia_kg_m2, (angle_rad - pulley.angle_rad) / time_step_s,
                           pulley.speed_rad_per_s, time_step_s);
}

// The torque lost to a pulley's friction and inertia at this angle (E27, E35).
PulleyTorque BenchPulleys::losses(const Pulley& pulley, Bearing bearing, const BearingFriction& friction,
                                  const Torque& of_inertia, double angle_rad, double pull_Nm,
                                  double time_step_s) {
    const double turned_rad = angle_rad - pulley.angle_rad;
    const double speed = turned_rad / time_step_s;
    const Bristle<double> sign = bearing == Bearing::finds_its_angle
                                     ? friction.bristle_after(pulley.bristle, turned_rad)
                                     : BearingFriction::sign_of(speed, time_step_s);
    const SpeedAtEnd end = speed_at_end(turned_rad, pulley.speed_rad_per_s, time_step_s);
    const Torque rubbing = friction.torque(sign, end.rad_per_s, end.per_rad);
    PulleyTorque lost = {rubbing.value_Nm + of_inertia.value_Nm, rubbing.per_rad + of_inertia.per_rad, 0.0};
    if (friction.per_torque > 0.0) {
        const double coulomb_Nm = friction.per_torque * std::abs(pull_Nm);
        lost.value_Nm += coulomb_Nm * sign.bend;
        lost.per_rad += coulomb_Nm * sign.bend_per_m;
        lost.per_pull = std::copysign(friction.per_torque, pull_Nm) * sign.bend;
    }
    return lost;
}

// A pulley whose angle is prescribed cannot creep, and its encoder knows little of the first tenth of a
// milliradian.
BenchPulleys::Bearing BenchPulleys::bearing_of(bool free, const BearingFriction& friction) {
    return free || friction.presliding_rad > 0.0 ? Bearing::finds_its_angle : Bearing::is_turned;
}

PulleyTorque BenchPulleys::motor_losses(const BenchInputs& inputs, double angle_rad, double pull_Nm) const {
    const bool is_free = motor_is_free(inputs);
    const BearingFriction& friction = effects_.of<PulleyFriction>().motor;
    return losses(motor_, bearing_of(is_free, friction), friction,
                  inertia_torque(motor_, known_.motor_kg_m2, angle_rad, inputs.time_step_s,
                                 is_free ? std::nullopt : inputs.motor_rad_per_s2),
                  angle_rad, pull_Nm, inputs.time_step_s);
}

PulleyTorque BenchPulleys::motor_balance(const BenchInputs& inputs, double angle_rad, double pull_Nm) const {
    const PulleyTorque lost = motor_losses(inputs, angle_rad, pull_Nm);
    const Torque swing = swing_torque(inputs, angle_rad);
    const Torque cogging = effects_.of<MotorCogging>().torque(angle_rad);
    const Torque spring = effects_.of<PositionTorque>().torque(angle_rad);
    Torque balance = {lost.value_Nm + swing.value_Nm + cogging.value_Nm + spring.value_Nm,
                      lost.per_rad + swing.per_rad + cogging.per_rad + spring.per_rad};
    if (const auto* torque = std::get_if<MotorTorque>(&inputs.motor)) {
        balance.value_Nm -= torque->torque_Nm - zeros_.motor_Nm;
    } else if (motor_is_free(inputs)) {
        const double across =
            Backlash::beyond_gap_rad(std::get<MotorAngle>(inputs.motor).angle_rad - angle_rad,
                                     effects_.of<Backlash>().motor_half_gap_rad);
        balance.value_Nm -= Backlash::contact_Nm_per_rad * across;
        balance.per_rad += across == 0.0 ? 0.0 : Backlash::contact_Nm_per_rad;
    }
    return {pull_Nm + balance.value_Nm, balance.per_rad, 1.0 + lost.per_pull};
}

// The torque taken by what holds the load pulley (E17, E29, E34).
Torque BenchPulleys::held_by(const BenchInputs& inputs, double angle_rad) const {
    if (const auto* torque = std::get_if<LoadTorque>(&inputs.load))
        return {torque->torque_Nm - zeros_.load_Nm, 0.0};
    const EnvironmentCoupling& coupling = effects_.of<EnvironmentCoupling>();
    if (const auto* spring = std::get_if<LoadSpring>(&inputs.load)) {
        const double stiffness = 1.0 / (1.0 / spring->stiffness_Nm_per_rad + coupling.compliance_rad_per_Nm);
        return {stiffness * (angle_rad - spring->wall_angle_rad), stiffness};
    }
    const double held_rad = std::get<LoadAngle>(inputs.load).angle_rad;
    const double stiffness = coupling.stiffness_Nm_per_rad();
    const double across =
        Backlash::beyond_gap_rad(angle_rad - held_rad, effects_.of<Backlash>().load_half_gap_rad);
    const double damping = coupling.damping_Nm_s_per_rad / inputs.time_step_s;
    const double spread_rad = (angle_rad - load_.angle_rad) - (held_rad - load_.encoder_rad);
    return {stiffness * across + damping * spread_rad, (across == 0.0 ? 0.0 : stiffness) + damping};
}

PulleyTorque BenchPulleys::load_balance(const BenchInputs& inputs, double angle_rad, double pull_Nm) const {
    const bool is_free = load_is_free(inputs);
    const BearingFriction& friction = effects_.of<PulleyFriction>().load;
    const PulleyTorque lost =
        losses(load_, bearing_of(is_free, friction), friction,
               inertia_torque(load_, load_inertia_kg_m2(inputs), angle_rad, inputs.time_step_s,
                              is_free ? std::nullopt : inputs.load_rad_per_s2),
               angle_rad, pull_Nm, inputs.time_step_s);
    const Torque taken = is_free ? held_by(inputs, angle_rad) : Torque{};
    return {pull_Nm + (-lost.value_Nm - taken.value_Nm), -lost.per_rad - taken.per_rad, 1.0 - lost.per_pull};
}

BenchPulleys::Swing BenchPulleys::swung(const Pulley& pulley, double angle_rad, double time_step_s) {
    const auto [speed, acceleration] = pulley.swing;
    const double h = time_step_s;
    const double now =
        (angle_rad - pulley.angle_rad - h * speed - h * h * (0.5 - newmark_beta) * acceleration) /
        (newmark_beta * h * h);
    return {speed + h * ((1.0 - newmark_gamma) * acceleration + newmark_gamma * now), now};
}

// The torque of the motor's unmodelled inertia and of what damps it, at an angle that it finds or is given.
Torque BenchPulleys::swing_torque(const BenchInputs& inputs, double angle_rad) const {
    const Inertia& unmodelled = effects_.of<Inertia>();
    if (unmodelled.motor_kg_m2 == 0.0) return {};
    const double damping_Nm_s = unmodelled.motor_kg_m2 * unmodelled.motor_decay_per_s;
    const double h = inputs.time_step_s;
    if (!motor_is_free(inputs)) {
        const SpeedAtEnd end = speed_at_end(angle_rad - motor_.angle_rad, motor_.speed_rad_per_s, h);
        const Torque torque =
            inertia_torque(motor_, unmodelled.motor_kg_m2, angle_rad, h, inputs.motor_rad_per_s2);
        return {torque.value_Nm + damping_Nm_s * end.rad_per_s, torque.per_rad + damping_Nm_s * end.per_rad};
    }
    const Swing swing = swung(motor_, angle_rad, h);
    return {unmodelled.motor_kg_m2 * swing.acceleration_rad_per_s2 + damping_Nm_s * swing.speed_rad_per_s,
            (unmodelled.motor_kg_m2 / h + damping_Nm_s * newmark_gamma) / (newmark_beta * h)};
}

void BenchPulleys::turn(Pulley& pulley, const BearingFriction& friction, double angle_rad,
                        double time_step_s) {
    const double turned_rad = angle_rad - pulley.angle_rad;
    pulley.bristle = friction.bristle_after(pulley.bristle, turned_rad).bend;
    pulley.swing = swung(pulley, angle_rad, time_step_s);
    pulley.speed_rad_per_s = turned_rad / time_step_s;
    pulley.angle_rad = angle_rad;
}

// The motor rests on the side of the gap that its torque presses on; without torque it stays.
double BenchPulleys::motor_stands_rad(double torque_Nm, double angle_rad) const {
    constexpr double leaning_Nm = 1e-3;
    const double gap_rad = effects_.of<Backlash>().motor_half_gap_rad;
    if (std::abs(torque_Nm) < leaning_Nm)
        return angle_rad + std::clamp(motor_.encoder_rad - angle_rad, -gap_rad, gap_rad);
    return angle_rad + gap_rad * std::clamp(torque_Nm / leaning_Nm, -1.0, 1.0);
}

void BenchPulleys::settle(const BenchInputs& inputs, const PulleyAngles& angles, double motor_pull_N,
                          double load_pull_N) {
    if (const auto* torque = std::get_if<MotorTorque>(&inputs.motor)) {
        motor_.torque_Nm = torque->torque_Nm - zeros_.motor_Nm;
        motor_.encoder_rad = motor_stands_rad(motor_.torque_Nm, angles.motor_rad);
    } else {
        const double pull_Nm = pulleys_.motor_radius_m *
                               effects_.of<EccentricPulley>().radius_ratio(angles.motor_rad) * motor_pull_N;
        motor_.torque_Nm = pull_Nm + motor_losses(inputs, angles.motor_rad, pull_Nm).value_Nm +
                           swing_torque(inputs, angles.motor_rad).value_Nm +
                           effects_.of<MotorCogging>().torque(angles.motor_rad).value_Nm +
                           effects_.of<PositionTorque>().torque(angles.motor_rad).value_Nm;
        motor_.encoder_rad = std::get<MotorAngle>(inputs.motor).angle_rad;
    }
    const auto* held = std::get_if<LoadAngle>(&inputs.load);
    load_.torque_Nm =
        load_is_free(inputs)
            ? held_by(inputs, angles.load_rad).value_Nm
            : load_balance(inputs, angles.load_rad, pulleys_.load_radius_m * load_pull_N).value_Nm;
    load_.encoder_rad = held != nullptr ? held->angle_rad : angles.load_rad;
    turn(motor_, effects_.of<PulleyFriction>().motor, angles.motor_rad, inputs.time_step_s);
    turn(load_, effects_.of<PulleyFriction>().load, angles.load_rad, inputs.time_step_s);
}

}  // namespace capstan
