#include "capstan/gap/partial_drive.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/twin.h"
#include "capstan/gap/bench_channels.h"
#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// Where a fit begins: a moderate friction exponent, cables that stretch by a tenth of the motion under the
// whole torque, and a pretension of a quarter of it.
constexpr double start_exponent = 0.5;
constexpr double start_stretch_fraction = 0.1;
constexpr double start_pretension_fraction = 0.25;

bool has(const Recording& recording, const char* name) {
    return recording.channel(name).has_value();
}

// The largest range in a run; `otherwise` where the channel was not recorded or stands still.
double span_of(const Recording& recording, const char* name, double otherwise) {
    if (!has(recording, name)) return otherwise;
    double span = 0.0;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        span = std::max(span, range_of(samples_of(recording, run, name)).span());
    }
    return span > 0.0 ? span : otherwise;
}

// The largest torque, either way: a constant load has no range.
double largest_of(const Recording& recording, const char* name, double otherwise) {
    if (!has(recording, name)) return otherwise;
    double largest = 0.0;
    for (std::size_t run = 0; run < recording.runs.size(); ++run)
        for (const double value : samples_of(recording, run, name))
            largest = std::max(largest, std::abs(value));
    return largest > 0.0 ? largest : otherwise;
}

const char* torque_channel(const Recording& recording) {
    return has(recording, channel::motor_torque) ? channel::motor_torque : channel::motor_current;
}

void demand_enough(const Recording& recording) {
    const bool angle = has(recording, channel::motor_angle);
    const bool torque = has(recording, torque_channel(recording));
    const bool load = has(recording, channel::load_angle) || has(recording, channel::load_torque);
    if (!angle && !torque)
        throw InvalidInput({recording.name +
                            ": a drive needs the channel motor_angle, motor_torque or motor_current, which "
                            "moves it"});
    if (!load && !(angle && torque))
        throw InvalidInput({recording.name +
                            ": a drive needs a channel that a model can be compared with: load_angle or "
                            "load_torque, or motor_torque beside motor_angle"});
}

bool second_end_pulls(const Recording& recording) {
    return recording.runs.front().drives("tension_2");
}

}  // namespace

bool is_complete_drive(const Recording& recording) {
    return std::all_of(channel::all.begin(), channel::all.end(),
                       [&](const char* name) { return has(recording, name); });
}

bool is_band_without_motion(const Recording& recording) {
    return recording.mode == BenchMode::capstan_band && !has(recording, "displacement") &&
           has(recording, "tension_1") && has(recording, "tension_2");
}

BenchEquivalence start_of_partial_drive(const Recording& recording) {
    demand_enough(recording);
    Recording named = recording;  // drive_orientation knows a current as a torque
    for (Channel& each : named.channels)
        if (each.name == channel::motor_current && !has(recording, channel::motor_torque))
            each.name = channel::motor_torque;
    const DriveOrientation orientation = drive_orientation(named);
    const double load_per_motor = std::abs(orientation.load_per_motor_angle);
    const bool knows_torque = has(recording, channel::motor_torque) || has(recording, channel::load_torque);
    const double current_A = largest_of(recording, channel::motor_current, 1.0);
    double torque_Nm =
        knows_torque ? load_per_motor * largest_of(recording, channel::load_torque, 1.0) : current_A;
    torque_Nm = largest_of(recording, channel::motor_torque, torque_Nm);
    const double turn_rad = span_of(recording, channel::motor_angle,
                                    span_of(recording, channel::load_angle, 1.0) / load_per_motor);
    const double stiffness_Nm_per_rad = torque_Nm / (start_stretch_fraction * turn_rad);

    BenchEquivalence start;
    start.bench = equivalent_pair(start_exponent, stiffness_Nm_per_rad, 1.0 / load_per_motor);
    start.motion_sign = orientation.load_per_motor_angle < 0.0 ? -1.0 : 1.0;
    start.motor_torque_sign = orientation.motor_torque_sign;
    start.load_torque_sign = orientation.load_torque_sign;
    start.pretension_N = start_pretension_fraction * torque_Nm / start.bench.motor_radius_m;
    if (!has(recording, channel::load_torque))
        start.bench.load_compliance_rad_per_Nm = turn_rad * load_per_motor / (torque_Nm / load_per_motor);
    // A current alone only sets the unit of all torques: N m stand for A.
    if (!has(recording, channel::motor_torque) && has(recording, channel::motor_current))
        start.bench.torque_constant_Nm_per_A = knows_torque ? torque_Nm / current_A : 1.0;
    return start;
}

Recording bench_of_partial_drive(const Recording& recording, const BenchEquivalence& equivalence) {
    demand_enough(recording);
    const bool turned = has(recording, channel::motor_angle);
    const bool loaded = has(recording, channel::load_torque);
    const char* torque = torque_channel(recording);
    const double torque_factor =
        equivalence.motor_torque_sign *
        (torque == channel::motor_current ? equivalence.bench.torque_constant_Nm_per_A : 1.0);

    Recording bench = recording;
    bench.mode = BenchMode::pull_pull;
    bench.nominal = equivalence.bench;
    bench.channels.clear();
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        bench.runs[run].pretension_N = equivalence.pretension_N;
        bench.runs[run].driven = {turned ? channel::motor_angle : channel::motor_torque};
        bench.runs[run].values.clear();
    }
    const auto add = [&](const char* from, const char* name, const char* unit, double factor,
                         bool from_zero) {
        if (!has(recording, from)) return;
        bench.channels.push_back(scaled_channel(recording, from, name, unit, factor));
        for (std::size_t run = 0; run < recording.runs.size(); ++run) {
            const std::vector<double>& values = samples_of(recording, run, from);
            bench.runs[run].values.push_back(
                scaled(values, factor, from_zero ? -factor * values.front() : 0.0));
        }
    };
    add(torque, channel::motor_torque, "N m", torque_factor, false);
    add(channel::motor_angle, channel::motor_angle, "rad", 1.0, true);
    add(channel::load_angle, channel::load_angle, "rad", equivalence.motion_sign, !turned && loaded);
    add(channel::load_torque, channel::load_torque, "N m", equivalence.load_torque_sign, false);
    if (!turned && loaded && !has(recording, channel::load_angle)) hold_load(bench);
    if (loaded) {
        for (RecordedRun& run : bench.runs)
            run.driven.emplace_back(turned ? channel::load_torque : channel::load_angle);
    }
    return bench;
}

// The stiffness sets no scale that a tension would show.
BenchEquivalence start_of_band_without_motion(const Recording& recording) {
    constexpr double stretch_fraction = 0.01;
    const double span_N = span_of(recording, second_end_pulls(recording) ? "tension_2" : "tension_1", 1.0);
    return {.bench = equivalent_cable(start_exponent, span_N / stretch_fraction)};
}

Recording bench_of_band_without_motion(const Recording& recording, const BenchEquivalence& equivalence) {
    constexpr double min_tension_N = 1e-3;
    const double radius_m = equivalence.bench.motor_radius_m;
    const bool second_pulls = second_end_pulls(recording);
    const char* pulling = second_pulls ? "tension_2" : "tension_1";
    const char* pulled = second_pulls ? "tension_1" : "tension_2";
    Recording bench = recording;
    bench.mode = BenchMode::single_cable;
    bench.nominal = equivalence.bench;
    bench.tension_sensors.clear();
    bench.channels = {scaled_channel(recording, pulling, channel::motor_torque, "N m", radius_m),
                      scaled_channel(recording, pulled, channel::load_torque, "N m", radius_m)};
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& tension_N = samples_of(recording, run, pulling);
        bench.runs[run].pretension_N =
            equivalence.pretension_over_stated_ratio * std::max(min_tension_N, tension_N.front());
        bench.runs[run].driven = {channel::motor_torque, channel::load_angle};
        bench.runs[run].output = OutputKind::locked;
        bench.runs[run].values = {scaled(tension_N, radius_m),
                                  scaled(samples_of(recording, run, pulled), radius_m)};
    }
    hold_load(bench);
    return bench;
}

}  // namespace capstan::gap
