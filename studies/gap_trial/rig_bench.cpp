#include "capstan/gap_trial/rig_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

// One to three bends of different radii that fill the length and wrap by an angle together.
std::vector<CurvaturePiece> draw_bends(double length_m, double wrap_rad, TrialStream& draws) {
    const int count = 1 + draws.integer_below(3);
    std::vector<double> lengths;
    std::vector<double> curvatures;
    double length = 0.0;
    double wrap = 0.0;
    for (int k = 0; k < count; ++k) {
        lengths.push_back(draws.uniform(0.5, 1.5));
        curvatures.push_back(draws.log_uniform(0.2, 1.0));
        length += lengths.back();
        wrap += lengths.back() * curvatures.back();
    }
    // Whole millimetres, as a sidecar states them.
    const auto rounded_mm = [](double value_m) { return 1e-3 * std::round(1e3 * value_m); };
    std::vector<CurvaturePiece> pieces;
    double reached_m = 0.0;
    for (int k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const double end_m =
            k + 1 == count ? length_m : reached_m + rounded_mm(lengths[at] / length * length_m);
        const double radius_m = wrap * length_m / (length * wrap_rad * curvatures[at]);
        pieces.push_back({end_m - reached_m, rounded_mm(radius_m)});
        reached_m = end_m;
    }
    return pieces;
}

void draw_cable(Rig& rig, double exponent, TrialStream& draws) {
    NominalBench& nominal = rig.bench.nominal;
    nominal.dynamic_friction = draws.uniform(0.10, 0.22);
    nominal.static_friction = nominal.dynamic_friction * draws.uniform(1.0, 2.5);
    const double wave_m_per_s = draws.uniform(650.0, 850.0);
    rig.bench.cable_mass_kg_per_m = nominal.axial_stiffness_N / (wave_m_per_s * wave_m_per_s);
    nominal.curvature = draw_bends(rig.bench.length_m(), exponent / nominal.dynamic_friction, draws);
}

void draw_tension_sensors(Rig& rig, int count, TrialStream& draws) {
    const double spacing_m = rig.bench.length_m() / count;
    for (int k = 0; k < count; ++k) {
        const double at_m = spacing_m * (k + 0.5 + draws.uniform(-0.3, 0.3));
        const CableName cable =
            rig.bench.is_pair() && draws.integer_below(3) == 0 ? CableName::b : CableName::a;
        rig.bench.tension_sensors.push_back(
            {fmt::format("tension_{}", k + 1), cable, 1e-3 * std::round(1e3 * at_m)});
    }
}

double draw_count_rad(TrialStream& draws) {
    constexpr double counts[] = {8000, 10000, 20000, 40000};
    return 2.0 * std::numbers::pi / counts[draws.integer_below(static_cast<int>(std::size(counts)))];
}

Rig draw_bench_rig(BenchKind kind, TrialStream& draws) {
    Rig rig;
    TrialBench& bench = rig.bench;
    bench.kind = kind;
    NominalBench& nominal = bench.nominal;
    const double length_m = 1e-2 * std::round(draws.uniform(80.0, 240.0));
    nominal.curvature = {{length_m, 1.0}};
    nominal.motor_radius_m = draws.uniform(0.012, 0.03);
    nominal.load_radius_m = draws.uniform(0.03, 0.10);
    nominal.axial_stiffness_N = draws.log_uniform(3000.0, 12000.0);
    draw_cable(rig, draws.uniform(0.35, 1.1), draws);
    rig.pretension_N = bench.is_pair() ? draws.log_uniform(5.0, 25.0) : draws.log_uniform(15.0, 40.0);
    if (bench.is_pair()) {
        nominal.rotor_inertia_kg_m2 =
            2e-2 * nominal.motor_radius_m * nominal.motor_radius_m * draws.uniform(0.7, 2.0);
        nominal.load_pulley_inertia_kg_m2 =
            1e-2 * nominal.load_radius_m * nominal.load_radius_m * draws.uniform(0.5, 2.0);
        if (draws.integer_below(3) == 0) draw_tension_sensors(rig, 3, draws);
    } else {
        draw_tension_sensors(rig, 3 + draws.integer_below(3), draws);
    }
    const double motor_Nm = rig.motor_torque_scale_Nm();
    const double load_Nm = rig.load_torque_scale_Nm();
    bench.noise_std = {{channel::motor_torque, motor_Nm * draws.log_uniform(1e-3, 4e-3)},
                       {channel::load_torque, load_Nm * draws.log_uniform(3e-3, 1e-2)}};
    bench.encoder_step = {{channel::motor_angle, draw_count_rad(draws)},
                          {channel::load_angle, 2.0 * std::numbers::pi / 40000}};
    bench.floor = {{channel::motor_torque, 8e-3 * motor_Nm},
                   {channel::motor_angle, 1e-3},
                   {channel::load_angle, 1e-3},
                   {channel::load_torque, 1.2e-2 * load_Nm}};
    for (const TensionSensor& sensor : bench.tension_sensors) {
        bench.noise_std[sensor.channel] = rig.pretension_N * draws.log_uniform(5e-3, 2e-2);
        bench.floor[sensor.channel] = 8e-3 * rig.pretension_N;
    }
    return rig;
}

// As the drive of a surgical grasper: a spindle turned by a servo, a jaw loaded by a motor.
Rig draw_drive_rig(TrialStream& draws) {
    Rig rig;
    TrialBench& bench = rig.bench;
    bench.kind = BenchKind::rig_drive;
    bench.logged_rate_Hz = 100;
    NominalBench& nominal = bench.nominal;
    const double length_m = draws.uniform(0.3, 0.6);
    nominal.curvature = {{length_m, 1.0}};
    nominal.motor_radius_m = draws.uniform(0.005, 0.010);
    nominal.load_radius_m = nominal.motor_radius_m / draws.uniform(0.6, 1.2);
    const double torsion_Nm_per_rad = draws.log_uniform(0.6, 2.5);
    nominal.axial_stiffness_N =
        torsion_Nm_per_rad / (nominal.motor_radius_m * nominal.motor_radius_m) * length_m;
    draw_cable(rig, draws.uniform(0.3, 0.8), draws);
    rig.pretension_N = draws.log_uniform(0.01, 0.04) / nominal.motor_radius_m;
    nominal.rotor_inertia_kg_m2 = draws.log_uniform(1e-6, 4e-6);
    nominal.load_pulley_inertia_kg_m2 = draws.log_uniform(5e-6, 2e-5);
    bench.load_angle_sign = draws.sign();
    bench.load_torque_sign = draws.sign();
    bench.load_angle_zero_rad = draws.uniform(-0.5, 1.3);
    bench.noise_std = {{channel::motor_torque, draws.log_uniform(2e-4, 1e-3)},
                       {channel::load_torque, draws.log_uniform(1e-4, 4e-4)}};
    bench.encoder_step = {{channel::motor_angle, 7.6699e-4}, {channel::load_angle, 1.5708e-3}};
    bench.floor = {{channel::motor_torque, 1.5e-3},
                   {channel::motor_angle, 1.5e-3},
                   {channel::load_angle, 1.0e-3},
                   {channel::load_torque, 8e-4}};
    return rig;
}

}  // namespace

double Rig::motor_torque_scale_Nm() const {
    return 2.0 * pretension_N * bench.nominal.motor_radius_m;
}

double Rig::load_torque_scale_Nm() const {
    return 2.0 * pretension_N * bench.nominal.load_radius_m;
}

Rig draw_rig(BenchKind kind, double noise_factor, TrialStream& draws) {
    Rig rig = kind == BenchKind::rig_drive ? draw_drive_rig(draws) : draw_bench_rig(kind, draws);
    for (auto& [channel, noise] : rig.bench.noise_std) noise *= noise_factor;
    return rig;
}

}  // namespace capstan::gap_trial
