#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "capstan/cable/cable_cut.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// The error of the quasi-static model itself, for a channel that varies by `spread` in a run: oscillation
// after a motion has passed, breakaway, discretisation. Measured on recordings without a gap: up to 0.7% of a
// torque or tension, 1.2% where the cable's losses are not known (E72), 2% of the torque at a load that is
// held, and 2% of a motor angle that only stretches the cables, less where it turns with the load.
double model_floor(const Recording& recording, const std::string& channel, bool load_is_held, double spread) {
    constexpr double turning_rad = 0.13;
    if (channel == channel::motor_angle) return 0.02 * spread / (1.0 + spread / turning_rad);
    if (channel == channel::load_torque && load_is_held) return 0.02 * spread;
    return (recording.nominal->is_equivalent ? 0.012 : 0.007) * spread;
}

double standard_deviation(const std::vector<double>& values) {
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / static_cast<double>(values.size()));
}

// E67. How much a torque or tension would vary if the cables slid all the way to where it is measured. Where
// the load is held it may feel little of it, but the error of where sliding ends goes with all of it. 0 for
// other channels, and where no motor torque was recorded.
double spread_brought_to(const std::string& channel, const Recording& recording, const RecordedRun& run) {
    const auto motor = recording.channel(channel::motor_torque);
    if (!motor) return 0.0;
    const NominalBench& bench = *recording.nominal;
    const double motor_N =
        standard_deviation(run.values[static_cast<std::size_t>(*motor)]) / bench.motor_radius_m;
    if (channel == channel::load_torque)
        return motor_N * bench.load_radius_m * std::exp(-bench.dynamic_friction * wrap_rad(bench.curvature));
    const double cables = recording.mode == BenchMode::single_cable ? 1.0 : 2.0;
    for (const TensionSensor& sensor : recording.tension_sensors) {
        if (sensor.channel != channel) continue;
        const double turned_rad = wrap_between_rad(bench.curvature, 0.0, sensor.position_m);
        return motor_N / cables * std::exp(-bench.dynamic_friction * turned_rad);
    }
    return 0.0;
}

double rms_difference(std::span<const double> a, std::span<const double> b) {
    double squares = 0.0;
    for (std::size_t sample = 0; sample < a.size(); ++sample)
        squares += (a[sample] - b[sample]) * (a[sample] - b[sample]);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

// Other measurements of the driven channels, as many times as a rare large one does not decide.
constexpr int measurements = 5;

// The bench as another measurement of its driven channels would move it.
EffectsTwin measured_again(const Recording& recording, const EffectsTwin& twin, int measurement) {
    std::vector<DrivenInputs> inputs;
    for (const RecordedRun& run : recording.runs)
        inputs.push_back(driven_inputs_again(recording, run, measurement));
    return twin.moved_by(std::move(inputs));
}

// The first sample at which the driving channel has been near both its extremes. Until then friction depends
// on how the bench was assembled. At most half the run.
int end_of_first_loading(const Recording& recording, const RecordedRun& run) {
    constexpr double near = 0.2;  // as a fraction of the span
    const bool turned = run.drives(channel::motor_angle);
    const bool locked = run.output != OutputKind::handle;
    const auto channel = recording.channel(turned   ? channel::motor_angle
                                           : locked ? channel::motor_torque
                                                    : channel::load_angle);
    if (!channel || !run.drives(recording.channels[static_cast<std::size_t>(*channel)].name)) return 0;
    const std::vector<double>& samples = run.values[static_cast<std::size_t>(*channel)];
    const auto [lowest, highest] = std::minmax_element(samples.begin(), samples.end());
    const double margin = near * (*highest - *lowest);
    bool been_low = false;
    bool been_high = false;
    const int half = static_cast<int>(samples.size() / 2);
    for (int sample = 0; sample < half; ++sample) {
        been_low |= samples[static_cast<std::size_t>(sample)] < *lowest + margin;
        been_high |= samples[static_cast<std::size_t>(sample)] > *highest - margin;
        if (been_low && been_high) return sample;
    }
    return half;
}

// An encoder that reads less than this apart may have turned either way between.
constexpr double steps_apart = 1.5;

// Samples at which an encoder has stayed within a step and a half for 50 ms: the angle may have turned round
// within the step, and the friction with it.
std::vector<bool> at_rest(const std::vector<double>& angle_rad, double step_rad, double sample_rate_Hz) {
    constexpr double duration_s = 0.05;
    std::vector<bool> rests(angle_rad.size(), false);
    std::size_t moved = 0;  // the last sample that was clearly elsewhere
    bool has_moved = false;
    for (std::size_t sample = 0; sample < angle_rad.size(); ++sample) {
        for (std::size_t earlier = sample; earlier > (has_moved ? moved : 0); --earlier) {
            if (std::abs(angle_rad[earlier - 1] - angle_rad[sample]) <= steps_apart * step_rad) continue;
            moved = earlier - 1;
            has_moved = true;
            break;
        }
        const auto since = static_cast<double>(sample - moved);
        rests[sample] = !has_moved || since > duration_s * sample_rate_Hz;
    }
    return rests;
}

// Samples within a step and a half of where an encoder turns round: the angle may have turned at any of them,
// and the friction with it. Of a single such sample nothing is in doubt: the reversal is known to a sample.
std::vector<bool> near_reversals(const std::vector<double>& angle_rad, double step_rad) {
    const double near_rad = steps_apart * step_rad;
    std::vector<bool> near(angle_rad.size(), false);
    std::size_t farthest = 0;  // of the motion that goes on
    double direction = 0.0;
    for (std::size_t sample = 0; sample < angle_rad.size(); ++sample) {
        const double moved_rad = angle_rad[sample] - angle_rad[farthest];
        if (direction * moved_rad > 0.0) {
            farthest = sample;
        } else if (std::abs(moved_rad) > near_rad) {
            std::size_t first = farthest;
            while (first > 0 && std::abs(angle_rad[first - 1] - angle_rad[farthest]) <= near_rad) --first;
            if (direction != 0.0 && sample - first > 1)
                std::fill(near.begin() + static_cast<std::ptrdiff_t>(first),
                          near.begin() + static_cast<std::ptrdiff_t>(sample), true);
            farthest = sample;
            direction = moved_rad;
        }
    }
    return near;
}

double mean_size(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += std::abs(value);
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// How far a cable's tension changes at the end that turns back by `turned_m`. The change falls over the
// length that it reaches by twice the friction, 2 q T per metre, and its strain over that length is the
// motion: turned = change^2 / (4 q T EA). A long motion stretches the complete cable (E55).
double change_at_reversal_N(const NominalBench& bench, double tension_N, double turned_m) {
    const double length_m = capstan::length_m(bench.curvature);
    const double friction_per_m = bench.dynamic_friction * wrap_rad(bench.curvature) / length_m;
    return std::max(bench.axial_stiffness_N / length_m * turned_m,
                    std::sqrt(4.0 * friction_per_m * tension_N * bench.axial_stiffness_N * turned_m));
}

// What one step of the encoder of a driven angle changes in a torque or tension at that end, after a
// reversal; at the other end, through the cables' own stiffness.
double change_by_a_step(const Recording& recording, const RecordedRun& run, const std::string& driven,
                        double step_rad, const Channel& channel) {
    NominalBench bench = *recording.nominal;
    const bool of_motor = driven == channel::motor_angle;
    const double radius_m = of_motor ? bench.motor_radius_m : bench.load_radius_m;
    const char* torque = of_motor ? channel::motor_torque : channel::load_torque;
    if (channel.name != torque) bench.dynamic_friction = 0.0;
    const auto recorded = recording.channel(torque);
    const double torque_Nm = recorded ? mean_size(run.values[static_cast<std::size_t>(*recorded)]) : 0.0;
    const double change_N = change_at_reversal_N(bench, run.pretension_N.value_or(0.0) + torque_Nm / radius_m,
                                                 radius_m * step_rad);
    if (channel.unit == "N") return change_N;
    const double cables = recording.mode == BenchMode::pull_pull ? 2.0 : 1.0;
    return cables * change_N *
           (channel.name == channel::motor_torque ? bench.motor_radius_m : bench.load_radius_m);
}

// Of the samples of a series. Empty: all.
std::vector<bool> determined_rows(const Recording& recording, const ResidualSeries& series, int stride) {
    std::vector<bool> determined;
    const RecordedRun& run = recording.runs[series.run];
    const Channel& predicted = recording.channels[series.channel];
    if (predicted.unit == "rad") return determined;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const Channel& driven = recording.channels[channel];
        if (!run.drives(driven.name) || driven.unit != "rad" || !driven.step) continue;
        const double step = *driven.step;
        std::vector<bool> doubtful(run.values[channel].size(), false);
        if (change_by_a_step(recording, run, driven.name, step, predicted) >= series.scale)
            doubtful = at_rest(run.values[channel], step, recording.sample_rate_Hz);
        // The friction of a drive's bearings turns round with the angle, too, which E55 does not count.
        if (recording.nominal->is_equivalent) {
            const std::vector<bool> turning = near_reversals(run.values[channel], step);
            std::transform(doubtful.begin(), doubtful.end(), turning.begin(), doubtful.begin(),
                           std::logical_or<>());
        }
        determined.resize(series.rows, true);
        for (std::size_t row = 0; row < series.rows; ++row) {
            if (doubtful[(static_cast<std::size_t>(series.first_sample) + row) *
                         static_cast<std::size_t>(stride)])
                determined[row] = false;
        }
    }
    if (std::find(determined.begin(), determined.end(), true) == determined.end()) determined.clear();
    return determined;
}

}  // namespace

std::size_t rows_of_a_block(double sample_rate_Hz, int stride) {
    return static_cast<std::size_t>(
        std::max(1.0, std::round(usual_correlation_time_s * sample_rate_Hz / stride)));
}

std::vector<ResidualBlock> blocks_of(const std::vector<ResidualSeries>& series, std::size_t channel,
                                     std::size_t rows) {
    std::vector<ResidualBlock> blocks;
    std::size_t of_channel = 0;
    for (const ResidualSeries& each : series) {
        if (each.channel != channel) continue;
        for (std::size_t row = 0; row < each.rows; row += rows) {
            const std::size_t end = std::min(row + rows, each.rows);
            const std::size_t determined = each.determined_rows(row, end);
            if (determined == 0) continue;
            blocks.push_back(
                {static_cast<Eigen::Index>(each.first_row + row), static_cast<Eigen::Index>(of_channel + row),
                 static_cast<Eigen::Index>(end - row), static_cast<double>(determined), each.noise_part});
        }
        of_channel += each.rows;
    }
    return blocks;
}

std::size_t ResidualSeries::determined_rows(std::size_t from, std::size_t to) const {
    std::size_t count = 0;
    for (std::size_t row = from; row < to; ++row) count += determines(row) ? 1 : 0;
    return count;
}

std::vector<LeftOut> left_out_in_turn(std::size_t runs, const std::vector<const CandidateCause*>& causes) {
    const bool in_halves =
        runs == 1 || std::any_of(causes.begin(), causes.end(), [](const CandidateCause* cause) {
            return cause->is_of_runs || cause->effect == "pretension_drift";
        });
    std::vector<LeftOut> parts;
    for (std::size_t run = 0; run < runs; ++run) {
        if (in_halves) {
            parts.push_back({run, 0.0, 0.5});
            parts.push_back({run, 0.5, 1.0});
        } else {
            parts.push_back({run});
        }
    }
    return parts;
}

std::vector<ResidualSeries> residual_series(const Recording& recording, const EffectsTwin& twin) {
    std::vector<ResidualSeries> all;
    std::size_t next_row = 0;
    std::vector<EffectsTwin> again;
    for (int measurement = 0; measurement < measurements; ++measurement)
        again.push_back(measured_again(recording, twin, measurement));
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const TwinRun nominal = twin.run(run, {});
        std::vector<TwinRun> moved_again;
        for (const EffectsTwin& each : again) moved_again.push_back(each.run(run, {}));
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (nominal.values[channel].empty()) continue;
            const Channel& described = recording.channels[channel];
            const int first = end_of_first_loading(recording, recording.runs[run]) / twin.stride();
            const auto later = [&](const TwinRun& moved) {
                return std::span(moved.values[channel]).subspan(static_cast<std::size_t>(first));
            };
            const bool load_is_held = recording.runs[run].output == OutputKind::locked;
            double spread = standard_deviation(recording.runs[run].values[channel]);
            if (load_is_held)
                spread = std::max(spread, spread_brought_to(described.name, recording, recording.runs[run]));
            const double floor = model_floor(recording, described.name, load_is_held, spread);
            std::vector<double> of_inputs;
            for (const TwinRun& each : moved_again)
                of_inputs.push_back(rms_difference(later(nominal), later(each)));
            const double noise = std::hypot(sample_noise(described), upper_median(of_inputs));
            const double scale = std::hypot(noise, floor);
            const std::size_t rows = later(nominal).size();
            all.push_back({run, channel, first, scale > 0.0 ? scale : 1.0, next_row, rows});
            if (scale > 0.0) all.back().noise_part = std::pow(noise / scale, 2);
            all.back().is_determined = determined_rows(recording, all.back(), twin.stride());
            next_row += rows;
        }
    }
    return all;
}

}  // namespace capstan::gap
