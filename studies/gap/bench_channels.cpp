#include "capstan/gap/bench_channels.h"

#include <cmath>

#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

constexpr double motor_radius_m = equivalent_motor_radius_m;
constexpr double length_m = 1.0;

NominalBench bench_with(double exponent, double axial_stiffness_N, double load_radius_m) {
    NominalBench bench;
    bench.is_equivalent = true;
    bench.curvature = {{length_m, length_m}};
    bench.motor_radius_m = motor_radius_m;
    bench.load_radius_m = load_radius_m;
    bench.axial_stiffness_N = axial_stiffness_N;
    bench.dynamic_friction = bench.static_friction = exponent;
    return bench;
}

}  // namespace

NominalBench equivalent_pair(double exponent, double stiffness_Nm_per_rad, double load_over_motor_radius) {
    return bench_with(exponent, stiffness_Nm_per_rad / (motor_radius_m * motor_radius_m) * length_m,
                      motor_radius_m * load_over_motor_radius);
}

NominalBench equivalent_cable(double exponent, double axial_stiffness_N) {
    return bench_with(exponent, axial_stiffness_N, motor_radius_m);
}

std::vector<double> scaled(const std::vector<double>& values, double factor, double offset) {
    std::vector<double> all;
    all.reserve(values.size());
    for (const double value : values) all.push_back(factor * value + offset);
    return all;
}

Channel scaled_channel(const Recording& recording, const char* from, const char* name, const char* unit,
                       double factor) {
    Channel channel = recording.channels[static_cast<std::size_t>(*recording.channel(from))];
    channel.name = name;
    channel.unit = unit;
    if (channel.noise_std) *channel.noise_std *= std::abs(factor);
    if (channel.step) *channel.step *= std::abs(factor);
    return channel;
}

void hold_load(Recording& bench) {
    bench.channels.push_back({channel::load_angle, "rad", {}, {}});
    for (RecordedRun& run : bench.runs) run.values.emplace_back(run.time_s.size(), 0.0);
}

const std::vector<double>& samples_of(const Recording& recording, std::size_t run, const char* channel) {
    return recording.runs[run].values[static_cast<std::size_t>(*recording.channel(channel))];
}

}  // namespace capstan::gap
