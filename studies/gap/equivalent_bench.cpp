#include "capstan/gap/equivalent_bench.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/calibration.h"
#include "capstan/calibration/twin.h"
#include "capstan/gap/bench_channels.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/partial_drive.h"
#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// Fits the nominal numbers of a bench whose sidecar does not state them.
void fit_nominal_numbers(Recording& bench) {
    const BenchKnowledge unknown = undescribed_bench(bench);
    const CauseFitter fitter(bench, {}, 0);
    CauseFitter::FitOptions options;
    options.balanced = true;
    const BenchNumbers numbers = bench_numbers(fitter.fit(nominal_hypothesis(unknown), options).hypothesis());
    bench.nominal->dynamic_friction *= numbers.friction_ratio;
    bench.nominal->static_friction *= numbers.friction_ratio;
    bench.nominal->axial_stiffness_N *= numbers.stiffness_ratio;
    bench.nominal->load_compliance_rad_per_Nm =
        numbers.effects.of<EnvironmentCoupling>().compliance_rad_per_Nm;
    const auto of_torque = numbers.sensor_faults.find(channel::motor_torque);
    if (of_torque != numbers.sensor_faults.end())
        bench.nominal->torque_constant_Nm_per_A /= of_torque->second.gain;
    for (RecordedRun& run : bench.runs) run.pretension_N = *run.pretension_N * numbers.pretension_ratio;
}

BenchEquivalence equivalence_of_drive(const Recording& fitted_to) {
    const std::vector<double> fitted = calibrate(fitted_to, {}).values();
    const double exponent = fitted[0];
    const double stiffness_Nm_per_rad = fitted[1];
    const double pretension_Nm = fitted[2];
    const double speed_ratio = fitted[3];
    const DriveOrientation orientation = drive_orientation(fitted_to);
    return {.bench = equivalent_pair(exponent, stiffness_Nm_per_rad, speed_ratio),
            .motion_sign = orientation.load_per_motor_angle < 0.0 ? -1.0 : 1.0,
            .motor_torque_sign = orientation.motor_torque_sign,
            .load_torque_sign = orientation.load_torque_sign,
            .pretension_N = pretension_Nm / equivalent_motor_radius_m};
}

// Of a drive or band of which not everything was recorded.
BenchEquivalence fitted_from(BenchEquivalence start, const Recording& fitted_to) {
    Recording bench = as_bench(fitted_to, start);
    const double pretension_N = *bench.runs.front().pretension_N;
    fit_nominal_numbers(bench);
    start.bench = *bench.nominal;
    const double ratio = *bench.runs.front().pretension_N / pretension_N;
    start.pretension_N *= ratio;
    start.pretension_over_stated_ratio *= ratio;
    return start;
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
        const std::vector<double>& motor_rad = samples_of(recording, run, channel::motor_angle);
        bench.runs[run].pretension_N = equivalence.pretension_N;
        bench.runs[run].driven = {channel::motor_angle, channel::load_torque};
        bench.runs[run].values = {
            scaled(samples_of(recording, run, channel::motor_torque), equivalence.motor_torque_sign),
            scaled(motor_rad, 1.0, -motor_rad.front()),
            scaled(samples_of(recording, run, channel::load_angle), equivalence.motion_sign),
            scaled(samples_of(recording, run, channel::load_torque), equivalence.load_torque_sign)};
    }
    return bench;
}

// Which end of the band is pulled while the displacement grows: that with the larger tension then.
double pulled_with_displacement(const Recording& recording) {
    double sum = 0.0;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& at = samples_of(recording, run, "displacement");
        const std::vector<double>& first_N = samples_of(recording, run, "tension_1");
        const std::vector<double>& second_N = samples_of(recording, run, "tension_2");
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
        const std::vector<double>& of_run = samples_of(recording, run, "tension_1");
        const std::vector<double>& stroke = samples_of(recording, run, "displacement");
        tension_N.insert(tension_N.end(), of_run.begin(), of_run.end());
        at_m.insert(at_m.end(), stroke.begin(), stroke.end());
    }
    std::sort(tension_N.begin(), tension_N.end());
    std::sort(at_m.begin(), at_m.end());
    const double slack_N = std::max(min_tension_N, tension_N[tension_N.size() / 10]);
    const double tight_N = std::max(2.0 * slack_N, tension_N[9 * tension_N.size() / 10]);
    const double stroke_m = at_m.back() - at_m.front();
    return {std::log(tight_N / slack_N), tight_N / (stroke_fraction * stroke_m)};  // of a metre
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
        scaled_channel(recording, "tension_1", channel::motor_torque, "N m", equivalent_motor_radius_m),
        scaled_channel(recording, "displacement", channel::motor_angle, "rad",
                       1.0 / equivalent_motor_radius_m),
        scaled_channel(recording, "displacement", channel::load_angle, "rad",
                       1.0 / equivalent_motor_radius_m),
        scaled_channel(recording, "tension_2", channel::load_torque, "N m", equivalent_motor_radius_m)};
    bench.tension_sensors.clear();
    bench.nominal = equivalence.bench;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double>& at_m = samples_of(recording, run, "displacement");
        const double way = equivalence.motion_sign;
        const std::vector<double> turned =
            scaled(at_m, way / equivalent_motor_radius_m, -way * at_m.front() / equivalent_motor_radius_m);
        bench.runs[run].pretension_N =
            *recording.runs[run].pretension_N * equivalence.pretension_over_stated_ratio;
        bench.runs[run].driven = {channel::motor_angle, channel::load_angle};
        bench.runs[run].output = OutputKind::handle;
        bench.runs[run].values = {scaled(samples_of(recording, run, "tension_1"), equivalent_motor_radius_m),
                                  turned, turned,
                                  scaled(samples_of(recording, run, "tension_2"), equivalent_motor_radius_m)};
    }
    return bench;
}

BenchEquivalence equivalence_of_band(const Recording& fitted_to) {
    const BandStart start = band_start(fitted_to);
    BenchEquivalence equivalence{.bench = equivalent_cable(start.exponent, start.axial_stiffness_N),
                                 .motion_sign = pulled_with_displacement(fitted_to)};
    Recording bench = bench_of_band(fitted_to, equivalence);
    fit_nominal_numbers(bench);
    equivalence.bench = *bench.nominal;
    equivalence.pretension_over_stated_ratio =
        *bench.runs.front().pretension_N / *fitted_to.runs.front().pretension_N;
    return equivalence;
}

void demand_channels_of(const Recording& recording) {
    if (recording.mode == BenchMode::capstan_band)
        demand_channels(recording, {"tension_1", "tension_2"}, "a band");
}

}  // namespace

bool has_unknown_geometry(const Recording& recording) {
    return recording.mode == BenchMode::lumped_drive || recording.mode == BenchMode::capstan_band;
}

BenchEquivalence fit_equivalence(const Recording& fitted_to) {
    if (!has_unknown_geometry(fitted_to)) throw InvalidInput({fitted_to.name + ": the geometry is known"});
    demand_channels_of(fitted_to);
    if (is_band_without_motion(fitted_to))
        return fitted_from(start_of_band_without_motion(fitted_to), fitted_to);
    if (fitted_to.mode == BenchMode::capstan_band) return equivalence_of_band(fitted_to);
    if (is_complete_drive(fitted_to)) return equivalence_of_drive(fitted_to);
    return fitted_from(start_of_partial_drive(fitted_to), fitted_to);
}

Recording as_bench(const Recording& recording, const BenchEquivalence& equivalence) {
    demand_channels_of(recording);
    const bool of_drive = recording.mode == BenchMode::lumped_drive;
    Recording bench =
        of_drive ? (is_complete_drive(recording) ? bench_of_drive(recording, equivalence)
                                                 : bench_of_partial_drive(recording, equivalence))
        : is_band_without_motion(recording) ? bench_of_band_without_motion(recording, equivalence)
                                            : bench_of_band(recording, equivalence);
    bench.nominal_is_fitted = true;
    bench.nominal->is_equivalent = true;
    return bench;
}

Recording equivalent_bench(const Recording& recording, const Recording& fitted_to) {
    return has_unknown_geometry(recording) ? as_bench(recording, fit_equivalence(fitted_to)) : recording;
}

}  // namespace capstan::gap
