#include "capstan/gap/bench_knowledge.h"

#include <algorithm>
#include <cmath>

#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// Wherever a search goes, the bench can still be built.
double bounded_ratio(double logarithm) {
    constexpr double max_log = 2.5;
    return std::exp(std::clamp(logarithm, -max_log, max_log));
}

FloatingNumber ratio(const std::string& name, double prior_std, const std::string& effect,
                     double BenchNumbers::*number) {
    return {.name = name,
            .prior_std = prior_std,
            .effect = effect,
            .component = "parameter",
            .apply = [number](BenchNumbers& bench, double value) { bench.*number = value; }};
}

// `stated`: a number that is far from its nominal value is a wrong one.
std::vector<FloatingNumber> ratios(double friction_std, double stiffness_std, double pretension_std,
                                   bool stated) {
    return {ratio("friction", friction_std, stated ? "param_mu" : "", &BenchNumbers::friction_ratio),
            ratio("stiffness", stiffness_std, stated ? "param_K" : "", &BenchNumbers::stiffness_ratio),
            ratio("pretension", pretension_std, stated ? "param_T0" : "", &BenchNumbers::pretension_ratio)};
}

// Half of what a channel covers over all runs.
double half_span(const Recording& recording, std::size_t channel) {
    double low = recording.runs.front().values[channel].front();
    double high = low;
    for (const RecordedRun& run : recording.runs) {
        const auto [least, most] =
            std::minmax_element(run.values[channel].begin(), run.values[channel].end());
        low = std::min(low, *least);
        high = std::max(high, *most);
    }
    return 0.5 * (high - low);
}

// A sensor's zero as a part of its span, bearings' friction as a part of the torque at their end.
void add_zeros_and_bearings(const Recording& recording, double zero_part, double bearing_part,
                            BenchKnowledge& bench) {
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        const std::string& unit = recording.channels[channel].unit;
        // The zero of a drive's angle is fitted with its other numbers.
        if ((unit == "rad" && recording.nominal_is_fitted) || !recording.is_predicted(name)) continue;
        bench.numbers.push_back({.name = "zero of " + name,
                                 .unit = unit,
                                 .kind = FloatingNumber::Kind::zero,
                                 .scale = half_span(recording, channel),
                                 .prior_std = zero_part,
                                 .of_a_sensor = true,
                                 .effect = "sensor_offset",
                                 .variant = name,
                                 .component = "sensor:" + name,
                                 .apply = [name](BenchNumbers& numbers, double value) {
                                     numbers.sensor_faults[name].offset = value;
                                 }});
    }
    // Channels are sampled one after the other, and an encoder holds its last count: their times agree to
    // about half a sample.
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        if (!recording.is_predicted(name)) continue;
        bench.numbers.push_back({.name = "time of " + name,
                                 .unit = "s",
                                 .kind = FloatingNumber::Kind::zero,
                                 .scale = 1.0 / recording.sample_rate_Hz,
                                 .prior_std = 0.5,
                                 .of_a_sensor = true,
                                 .usual = 1.0,
                                 .effect = "time_misalignment",
                                 .variant = name,
                                 .component = "sensor:" + name,
                                 .apply = [name](BenchNumbers& numbers, double value) {
                                     numbers.sensor_faults[name].delay_s += value;
                                 }});
    }
    const auto add_bearing = [&](const char* torque, const char* name, const char* component, const char* end,
                                 BearingFriction PulleyFriction::*at) {
        const auto channel = recording.channel(torque);
        if (!channel) return;
        bench.numbers.push_back({.name = name,
                                 .unit = "N m",
                                 .kind = FloatingNumber::Kind::size,
                                 .scale = half_span(recording, static_cast<std::size_t>(*channel)),
                                 .prior_std = bearing_part,
                                 .effect = "pulley_friction",
                                 .variant = end,
                                 .component = component,
                                 .end = end,
                                 .apply = [at](BenchNumbers& numbers, double value) {
                                     (numbers.effects.of<PulleyFriction>().*at).coulomb_Nm = value;
                                 }});
    };
    add_bearing(channel::motor_torque, "friction of the motor's bearing", "motor", "motor",
                &PulleyFriction::motor);
    if (recording.mode == BenchMode::pull_pull)
        add_bearing(channel::load_torque, "friction of the load's bearing", "load_pulley", "load",
                    &PulleyFriction::load);
}

// The friction of a bearing builds up while its balls, seal and gears wind up: over a hundredth of a degree
// in a plain bearing, over a degree behind a gear.
FloatingNumber presliding_of_bearings() {
    constexpr double usual_rad = 2e-3;
    constexpr double by_a_factor_of_three = 1.2;
    return {.name = "presliding of the bearings",
            .prior_std = by_a_factor_of_three,
            .apply = [](BenchNumbers& numbers, double value) {
                PulleyFriction& bearings = numbers.effects.of<PulleyFriction>();
                bearings.motor.presliding_rad = bearings.load.presliding_rad = usual_rad * value;
            }};
}

}  // namespace

double FloatingNumber::value(double coordinate) const {
    switch (kind) {
        case Kind::ratio:
            return bounded_ratio(coordinate);
        case Kind::size:
            return scale * std::max(0.0, coordinate);
        case Kind::zero:
            return scale * coordinate;
    }
    return 0.0;
}

const BenchKnowledge& measured_bench() {
    static const BenchKnowledge bench{ratios(nominal_log_std, nominal_log_std, nominal_log_std, true)};
    return bench;
}

BenchKnowledge built_bench(const Recording& recording) {
    constexpr double friction_and_wrap = 0.22;
    constexpr double stiffness = 0.10;
    constexpr double pretension = 0.15;
    constexpr double zero_part = 0.03;
    constexpr double bearing_part = 0.03;
    BenchKnowledge bench{ratios(friction_and_wrap, stiffness, pretension, true)};
    add_zeros_and_bearings(recording, zero_part, bearing_part, bench);
    return bench;
}

BenchKnowledge undescribed_bench(const Recording& recording) {
    constexpr double by_factors = 1.0;
    // Nobody zeroed the sensors or stated their range, and bearings may take a third of a small drive's
    // torque.
    constexpr double zero_part = 0.1;
    constexpr double bearing_part = 0.3;
    BenchKnowledge bench{ratios(by_factors, by_factors, by_factors, false)};
    add_zeros_and_bearings(recording, zero_part, bearing_part, bench);
    bench.numbers.push_back(presliding_of_bearings());
    return bench;
}

}  // namespace capstan::gap
