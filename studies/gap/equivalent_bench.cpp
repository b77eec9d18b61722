#include "capstan/gap/equivalent_bench.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/calibration.h"
#include "capstan/calibration/twin.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

constexpr double motor_radius_m = 0.02;
// One metre of cable with one radian of wrap: the friction coefficient is the complete exponent.
constexpr double length_m = 1.0;

std::vector<double> scaled(const std::vector<double>& values, double factor, double offset = 0.0) {
    std::vector<double> all;
    for (const double value : values) all.push_back(factor * value + offset);
    return all;
}

Channel scaled_channel(const Recording& recording, const char* from, const char* name, const char* unit,
                       double factor) {
    Channel channel = recording.channels[static_cast<std::size_t>(*recording.channel(from))];
    channel.name = name;
    channel.unit = unit;
    if (channel.noise_std) *channel.noise_std *= factor;
    if (channel.step) *channel.step *= factor;
    return channel;
}

const std::vector<double>& samples(const Recording& recording, std::size_t run, const char* channel) {
    return recording.runs[run].values[static_cast<std::size_t>(*recording.channel(channel))];
}

NominalBench bench_with(double exponent, double axial_stiffness_N, double load_radius_m) {
    NominalBench bench;
    bench.curvature = {{length_m, length_m}};
    bench.motor_radius_m = motor_radius_m;
    bench.load_radius_m = load_radius_m;
    bench.axial_stiffness_N = axial_stiffness_N;
    bench.dynamic_friction = bench.static_friction = exponent;
    return bench;
}

// Fits the nominal numbers of a bench whose sidecar does not state them.
void fit_nominal_numbers(Recording& bench) {
    const BenchKnowledge unknown = undescribed_bench(bench);
    const CauseFitter fitter(bench, {}, 0);
    const BenchNumbers numbers = bench_numbers(fitter.fit(nominal_hypothesis(unknown), {}).hypothesis());
    bench.nominal->dynamic_friction *= numbers.friction_ratio;
    bench.nominal->static_friction *= numbers.friction_ratio;
    bench.nominal->axial_stiffness_N *= numbers.stiffness_ratio;
    for (RecordedRun& run : bench.runs) run.pretension_N = *run.pretension_N * numbers.pretension_ratio;
}

Recording bench_of_drive(const Recording& recording, const Recording& fitted_to) {
    const std::vector<double> fitted = calibrate(fitted_to, {}).values();
    const double exponent = fitted[0];
    const double stiffness_Nm_per_rad = fitted[1];
    const double pretension_Nm = fitted[2];
    const double speed_ratio = fitted[3];
    const DriveOrientation orientation = drive_orientation(fitted_to);
    const double way = orientation.load_per_motor_angle < 0.0 ? -1.0 : 1.0;

    Recording bench = recording;
    bench.nominal_is_fitted = true;
    bench.mode = BenchMode::pull_pull;
    bench.channels = {scaled_channel(recording, channel::motor_torque, channel::motor_torque, "N m", 1.0),
                      scaled_channel(recording, channel::motor_angle, channel::motor_angle, "rad", 1.0),
                      scaled_channel(recording, channel::load_angle, channel::load_angle, "rad", 1.0),
                      scaled_channel(recording, channel::load_torque, channel::load_torque, "N m", 1.0)};
    bench.nominal = bench_with(exponent, stiffness_Nm_per_rad / (motor_radius_m * motor_radius_m) * length_m,
                               motor_radius_m * speed_ratio);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& motor_rad = samples(recording, run, channel::motor_angle);
        bench.runs[run].pretension_N = pretension_Nm / motor_radius_m;
        bench.runs[run].driven = {channel::motor_angle, channel::load_torque};
        bench.runs[run].values = {
            scaled(samples(recording, run, channel::motor_torque), orientation.motor_torque_sign),
            scaled(motor_rad, 1.0, -motor_rad.front()),
            scaled(samples(recording, run, channel::load_angle), way),
            scaled(samples(recording, run, channel::load_torque), orientation.load_torque_sign)};
    }
    return bench;
}

// Which end of the band is pulled while the displacement grows: that with the larger tension then.
double pulled_with_displacement(const Recording& recording) {
    double sum = 0.0;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& at = samples(recording, run, "displacement");
        const std::vector<double>& first_N = samples(recording, run, "tension_1");
        const std::vector<double>& second_N = samples(recording, run, "tension_2");
        for (std::size_t sample = 1; sample < at.size(); ++sample)
            sum += (at[sample] - at[sample - 1]) * (first_N[sample] - second_N[sample]);
    }
    return sum < 0.0 ? -1.0 : 1.0;
}

// Where the fit of an undescribed band begins: the tight end's tension over the slack end's, and a band that
// is tight after a tenth of the stroke.
struct BandStart {
    double exponent = 1.0;
    double axial_stiffness_N = 1.0;
};

BandStart band_start(const Recording& recording) {
    constexpr double stroke_fraction = 0.1;
    constexpr double min_tension_N = 1.0;
    std::vector<double> tension_N;
    std::vector<double> at_m;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& of_run = samples(recording, run, "tension_1");
        const std::vector<double>& stroke = samples(recording, run, "displacement");
        tension_N.insert(tension_N.end(), of_run.begin(), of_run.end());
        at_m.insert(at_m.end(), stroke.begin(), stroke.end());
    }
    std::sort(tension_N.begin(), tension_N.end());
    std::sort(at_m.begin(), at_m.end());
    const double slack_N = std::max(min_tension_N, tension_N[tension_N.size() / 10]);
    const double tight_N = std::max(2.0 * slack_N, tension_N[9 * tension_N.size() / 10]);
    const double stroke_m = at_m.back() - at_m.front();
    return {std::log(tight_N / slack_N), tight_N / (stroke_fraction * stroke_m) * length_m};
}

Recording bench_of_band(const Recording& recording, const Recording& fitted_to) {
    for (const char* channel : {"displacement", "tension_1", "tension_2"}) {
        if (!recording.channel(channel))
            throw InvalidInput({recording.name + ": a band needs the channel " + channel});
    }
    const double way = pulled_with_displacement(fitted_to);
    const BandStart start = band_start(fitted_to);
    const auto as_bench = [&](const Recording& of) {
        Recording bench = of;
        bench.mode = BenchMode::single_cable;
        bench.channels = {
            scaled_channel(of, "tension_1", channel::motor_torque, "N m", motor_radius_m),
            scaled_channel(of, "displacement", channel::motor_angle, "rad", 1.0 / motor_radius_m),
            scaled_channel(of, "displacement", channel::load_angle, "rad", 1.0 / motor_radius_m),
            scaled_channel(of, "tension_2", channel::load_torque, "N m", motor_radius_m)};
        bench.tension_sensors.clear();
        bench.nominal = bench_with(start.exponent, start.axial_stiffness_N, motor_radius_m);
        for (std::size_t run = 0; run < of.runs.size(); ++run) {
            const std::vector<double>& at_m = samples(of, run, "displacement");
            const std::vector<double> turned =
                scaled(at_m, way / motor_radius_m, -way * at_m.front() / motor_radius_m);
            bench.runs[run].driven = {channel::motor_angle, channel::load_angle};
            bench.runs[run].output = OutputKind::handle;
            bench.runs[run].values = {scaled(samples(of, run, "tension_1"), motor_radius_m), turned, turned,
                                      scaled(samples(of, run, "tension_2"), motor_radius_m)};
        }
        return bench;
    };
    Recording bench = as_bench(fitted_to);
    fit_nominal_numbers(bench);
    Recording equivalent = as_bench(recording);
    equivalent.nominal_is_fitted = true;
    const double pretension_ratio = *bench.runs.front().pretension_N / *fitted_to.runs.front().pretension_N;
    equivalent.nominal = bench.nominal;
    for (RecordedRun& run : equivalent.runs) run.pretension_N = *run.pretension_N * pretension_ratio;
    return equivalent;
}

}  // namespace

Recording equivalent_bench(const Recording& recording, const Recording& fitted_to) {
    if (recording.mode == BenchMode::lumped_drive) return bench_of_drive(recording, fitted_to);
    if (recording.mode == BenchMode::capstan_band) return bench_of_band(recording, fitted_to);
    return recording;
}

}  // namespace capstan::gap
