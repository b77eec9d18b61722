#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/cable/cable_cut.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/recording/channel_range.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"

namespace capstan {

namespace {

// Samples may jitter by half a period; more than one and a half is a gap.
constexpr double longest_period_in_samples = 1.5;
// Units are called swapped when a relation that geometry fixes is off by more than this; friction and
// elasticity explain a factor of a few.
constexpr double implausible_factor = 20.0;

double largest_span(const Recording& recording, int channel, OutputKind output) {
    double span = 0.0;
    for (const RecordedRun& run : recording.runs) {
        if (run.output == output || output == OutputKind::unknown)
            span = std::max(span, range_of(run.values[static_cast<std::size_t>(channel)]).span());
    }
    return span;
}

bool is_driven(const Recording& recording, const std::string& channel) {
    return std::any_of(recording.runs.begin(), recording.runs.end(),
                       [&](const RecordedRun& run) { return run.drives(channel); });
}

void check_constant_channels(const Recording& recording, const std::string& place, ProblemList& problems) {
    bool any_input_moves = false;
    for (std::size_t index = 0; index < recording.channels.size(); ++index) {
        const std::string& name = recording.channels[index].name;
        const bool constant = largest_span(recording, index) == 0.0;
        if (is_driven(recording, name)) {
            any_input_moves |= !constant;
        } else if (constant && name != channel::load_angle) {  // a lock may hold perfectly
            problems.add(place,
                         fmt::format("column '{}' never changes; a sensor that is not connected? Leave the "
                                     "column out, here and in the sidecar",
                                     name));
        }
    }
    if (!any_input_moves)
        problems.add(place, "no driven channel ever changes: nothing moves in this recording");
}

// Span of `first` over that of `second`, where both are there and move.
std::optional<double> span_ratio(const Recording& recording, const char* first, const char* second,
                                 OutputKind output) {
    const auto a = recording.channel(first);
    const auto b = recording.channel(second);
    if (!a || !b) return std::nullopt;
    const double span_a = largest_span(recording, *a, output);
    const double span_b = largest_span(recording, *b, output);
    if (span_a == 0.0 || span_b == 0.0) return std::nullopt;
    return span_a / span_b;
}

// A handle turns the motor pulley by the ratio of the radii, give or take what the cables stretch.
void check_angle_units(const Recording& recording, const std::string& place, ProblemList& problems) {
    const auto ratio = span_ratio(recording, channel::motor_angle, channel::load_angle, OutputKind::handle);
    if (!ratio) return;
    const double expected = recording.nominal->load_radius_m / recording.nominal->motor_radius_m;
    const double off = *ratio / expected;
    if (off < implausible_factor && off > 1.0 / implausible_factor) return;
    problems.add(place,
                 fmt::format("motor_angle turns {:.3g} times as far as load_angle, the pulleys' radii say "
                             "{:.3g}: {} in degrees (rad is needed), or are r_input and r_load swapped?",
                             *ratio, expected, off > 1.0 ? "is motor_angle" : "is load_angle"));
}

void check_torque_units(const Recording& recording, const std::string& place, ProblemList& problems) {
    const auto ratio =
        span_ratio(recording, channel::load_torque, channel::motor_torque, OutputKind::unknown);
    if (!ratio) return;
    const double ideal = recording.nominal->load_radius_m / recording.nominal->motor_radius_m;
    // Friction can keep a torque from the load altogether, but nothing makes it larger than exp(mu wrap)
    // allows.
    const double exponent = recording.nominal->dynamic_friction * wrap_rad(recording.nominal->curvature);
    const double most = ideal * std::exp(exponent) * implausible_factor;
    if (*ratio > most)
        problems.add(place,
                     fmt::format("load_torque spans {:.3g} times what motor_torque does, friction explains "
                                 "at most {:.3g}: is one of them not in N m?",
                                 *ratio, most / implausible_factor));
}

}  // namespace

void check_next_time(const RecordedRun& run, double time_s, double sample_rate_Hz, const std::string& place,
                     ProblemList& problems) {
    if (run.time_s.empty()) return;
    const double step_s = time_s - run.time_s.back();
    if (step_s <= 0.0) {
        problems.add_line(fmt::format("order {}", run.number), place,
                          fmt::format("time {} s of run {} does not come after {} s", time_s, run.number,
                                      run.time_s.back()));
    } else if (step_s * sample_rate_Hz > longest_period_in_samples) {
        problems.add_line(
            fmt::format("gap {}", run.number), place,
            fmt::format("a gap of {:.4g} s in run {} at {} Hz; friction remembers what happened in it: "
                        "split the run there. `capstan import` does",
                        step_s, run.number, sample_rate_Hz));
    }
}

void check_recording(const Recording& recording, const std::string& place, ProblemList& problems) {
    for (const RecordedRun& run : recording.runs) {
        if (run.time_s.size() < min_run_samples)
            problems.add(place, fmt::format("run {} has {}; at least {} are needed", run.number,
                                            counted(run.time_s.size(), "sample"), min_run_samples));
    }
    if (!problems.empty()) return;
    check_constant_channels(recording, place, problems);
    if (!recording.nominal) return;
    check_angle_units(recording, place, problems);
    check_torque_units(recording, place, problems);
}

}  // namespace capstan
