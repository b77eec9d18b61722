#include "capstan/gap_trial/trial_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

constexpr double length_m = 2.0;
constexpr double tight_radius_m = 0.28;
constexpr double nearly_straight_radius_m = 5.0;

std::vector<CurvaturePiece> routing(BenchKind kind) {
    switch (kind) {
        case BenchKind::uniform_tight:
            return {{length_m, tight_radius_m}};
        case BenchKind::uniform_wide:
            return {{length_m, 0.70}};
        case BenchKind::one_bend:
            return {{0.6, nearly_straight_radius_m}, {0.8, tight_radius_m}, {0.6, nearly_straight_radius_m}};
        case BenchKind::single_cable:
            return {{length_m, 0.80}};
        case BenchKind::rig_pair:
        case BenchKind::rig_single:
        case BenchKind::rig_drive:
            break;  // drawn with the rig
    }
    return {};
}

// One near each end, the others spread between.
std::vector<TensionSensor> draw_sensors(int count, TrialStream& draws) {
    std::vector<TensionSensor> sensors;
    for (int k = 0; k < count; ++k) {
        const double middle_m = length_m * (k + 0.5) / count;
        const double reach_m = 0.25 * length_m / count;
        const double position_m = std::round(1e3 * draws.uniform(middle_m - reach_m, middle_m + reach_m));
        sensors.push_back({fmt::format("tension_{}", k + 1), CableName::a, 1e-3 * position_m});
    }
    return sensors;
}

}  // namespace

std::string bench_kind_name(BenchKind kind) {
    switch (kind) {
        case BenchKind::uniform_tight:
            return "uniform_tight";
        case BenchKind::uniform_wide:
            return "uniform_wide";
        case BenchKind::one_bend:
            return "one_bend";
        case BenchKind::single_cable:
            return "single_cable";
        case BenchKind::rig_pair:
            return "rig_pair";
        case BenchKind::rig_single:
            return "rig_single";
        case BenchKind::rig_drive:
            return "rig_drive";
    }
    return "";
}

double TrialBench::length_m() const {
    double length = 0.0;
    for (const CurvaturePiece& piece : nominal.curvature) length += piece.length_m;
    return length;
}

std::vector<std::string> TrialBench::channels() const {
    std::vector<std::string> names = {channel::motor_torque, channel::motor_angle, channel::load_angle,
                                      channel::load_torque};
    for (const TensionSensor& sensor : tension_sensors) names.push_back(sensor.channel);
    return names;
}

TrialBench make_trial_bench(BenchKind kind, double noise_factor, TrialStream& draws) {
    TrialBench bench;
    bench.kind = kind;
    bench.nominal.curvature = routing(kind);
    bench.nominal.motor_radius_m = 0.02;
    bench.nominal.load_radius_m = 0.104;
    bench.nominal.axial_stiffness_N = 2000.0 * length_m;
    bench.nominal.dynamic_friction = 0.21;
    bench.nominal.static_friction = 0.63;
    constexpr double fine_count_rad = 2.0 * std::numbers::pi / 40000;
    if (bench.is_pair()) {
        bench.nominal.rotor_inertia_kg_m2 = 8.3e-6;
        bench.nominal.load_pulley_inertia_kg_m2 = 1e-4;
        bench.noise_std = {{channel::motor_torque, 3e-4},
                           {channel::load_torque, kind == BenchKind::uniform_tight ? 0.02 : 0.01}};
        bench.encoder_step = {{channel::motor_angle, 2.0 * std::numbers::pi / 8000},
                              {channel::load_angle, fine_count_rad}};
    } else {
        bench.noise_std = {{channel::motor_torque, 1.5e-3}, {channel::load_torque, 6e-3}};
        bench.encoder_step = {{channel::motor_angle, fine_count_rad}, {channel::load_angle, fine_count_rad}};
    }
    const bool has_sensors = draws.integer_below(3) == 0 || !bench.is_pair();
    if (has_sensors) bench.tension_sensors = draw_sensors(bench.is_pair() ? 3 : 5, draws);
    for (const TensionSensor& sensor : bench.tension_sensors) bench.noise_std[sensor.channel] = 0.25;
    for (auto& [channel, noise] : bench.noise_std) noise *= noise_factor;
    return bench;
}

}  // namespace capstan::gap_trial
