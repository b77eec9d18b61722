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

BenchEquivalence equivalence_of_drive(const Recording& fitted_to) {
    const std::vector<double> fitted = calibrate(fitted_to, {}).values();
    const double exponent = fitted[0];
    const double stiffness_Nm_per_rad = fitted[1];
    const double pretension_Nm = fitted[2];
    const double speed_ratio = fitted[3];
    const DriveOrientation orientation = drive_orientation(fitted_to);
    return {.bench = bench_with(exponent, stiffness_Nm_per_rad / (motor_radius_m * motor_radius_m) * length_m,
                                motor_radius_m * speed_ratio),
            .motion_sign = orientation.load_per_motor_angle < 0.0 ? -1.0 : 1.0,
            .motor_torque_sign = orientation.motor_torque_sign,
            .load_torque_sign = orientation.load_torque_sign,
            .pretension_N = pretension_Nm / motor_radius_m};
}

Recording bench_of_drive(const Recording& recording, const BenchEquivalence& equivalence) {
    Recording bench = recording;
    bench.mode = BenchMode::pull_pull;
    bench.channels = {scaled_channel(recording, channel::motor_torque, channel::motor_torque, "N m", 1.0),
                      scaled_channel(recording, channel::motor_angle, channel::motor_angle, "rad", 1.0),
                      scaled_channel(recording, channel::load_angle, channel::load_angle, "rad", 1.0),
                      scaled_channel(recording, channel::load_torque, channel::load_torque, "N m", 1.0)};
    bench.nominal = equivalence.bench;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& motor_rad = samples(recording, run, channel::motor_angle);
        bench.runs[run].pretension_N = equivalence.pretension_N;
        bench.runs[run].driven = {channel::motor_angle, channel::load_torque};
        bench.runs[run].values = {
            scaled(samples(recording, run, channel::motor_torque), equivalence.motor_torque_sign),
            scaled(motor_rad, 1.0, -motor_rad.front()),
            scaled(samples(recording, run, channel::load_angle), equivalence.motion_sign),
            scaled(samples(recording, run, channel::load_torque), equivalence.load_torque_sign)};
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

void demand_channels(const Recording& recording, std::initializer_list<const char*> channels,
                     const std::string& what) {
    std::vector<std::string> problems;
    for (const char* name : channels) {
        if (!recording.channel(name))
            problems.push_back(recording.name + ": " + what + " needs the channel " + name);
    }
    if (!problems.empty()) throw InvalidInput(std::move(problems));
}

Recording bench_of_band(const Recording& recording, const BenchEquivalence& equivalence) {
    Recording bench = recording;
    bench.mode = BenchMode::single_cable;
    bench.channels = {
        scaled_channel(recording, "tension_1", channel::motor_torque, "N m", motor_radius_m),
        scaled_channel(recording, "displacement", channel::motor_angle, "rad", 1.0 / motor_radius_m),
        scaled_channel(recording, "displacement", channel::load_angle, "rad", 1.0 / motor_radius_m),
        scaled_channel(recording, "tension_2", channel::load_torque, "N m", motor_radius_m)};
    bench.tension_sensors.clear();
    bench.nominal = equivalence.bench;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& at_m = samples(recording, run, "displacement");
        const double way = equivalence.motion_sign;
        const std::vector<double> turned =
            scaled(at_m, way / motor_radius_m, -way * at_m.front() / motor_radius_m);
        bench.runs[run].pretension_N =
            *recording.runs[run].pretension_N * equivalence.pretension_over_stated_ratio;
        bench.runs[run].driven = {channel::motor_angle, channel::load_angle};
        bench.runs[run].output = OutputKind::handle;
        bench.runs[run].values = {scaled(samples(recording, run, "tension_1"), motor_radius_m), turned,
                                  turned, scaled(samples(recording, run, "tension_2"), motor_radius_m)};
    }
    return bench;
}

BenchEquivalence equivalence_of_band(const Recording& fitted_to) {
    const BandStart start = band_start(fitted_to);
    BenchEquivalence equivalence{.bench = bench_with(start.exponent, start.axial_stiffness_N, motor_radius_m),
                                 .motion_sign = pulled_with_displacement(fitted_to)};
    Recording bench = bench_of_band(fitted_to, equivalence);
    fit_nominal_numbers(bench);
    equivalence.bench = *bench.nominal;
    equivalence.pretension_over_stated_ratio =
        *bench.runs.front().pretension_N / *fitted_to.runs.front().pretension_N;
    return equivalence;
}

void demand_channels_of(const Recording& recording) {
    if (recording.mode == BenchMode::lumped_drive)
        demand_channels(
            recording,
            {channel::motor_torque, channel::motor_angle, channel::load_angle, channel::load_torque},
            "a drive of unknown geometry");
    else
        demand_channels(recording, {"displacement", "tension_1", "tension_2"}, "a band");
}

}  // namespace

bool has_unknown_geometry(const Recording& recording) {
    return recording.mode == BenchMode::lumped_drive || recording.mode == BenchMode::capstan_band;
}

BenchEquivalence fit_equivalence(const Recording& fitted_to) {
    if (!has_unknown_geometry(fitted_to)) throw InvalidInput({fitted_to.name + ": the geometry is known"});
    demand_channels_of(fitted_to);
    return fitted_to.mode == BenchMode::lumped_drive ? equivalence_of_drive(fitted_to)
                                                     : equivalence_of_band(fitted_to);
}

Recording as_bench(const Recording& recording, const BenchEquivalence& equivalence) {
    demand_channels_of(recording);
    Recording bench = recording.mode == BenchMode::lumped_drive ? bench_of_drive(recording, equivalence)
                                                                : bench_of_band(recording, equivalence);
    bench.nominal_is_fitted = true;
    return bench;
}

Recording equivalent_bench(const Recording& recording, const Recording& fitted_to) {
    return has_unknown_geometry(recording) ? as_bench(recording, fit_equivalence(fitted_to)) : recording;
}

}  // namespace capstan::gap
