#include "capstan/effects/sensor_faults.h"

#include <algorithm>
#include <cmath>

#include "capstan/effects/presliding.h"

namespace capstan {

namespace {

// E65. The elastic body of the cell drags friction along: the reading trails by bristles as wide as the loop,
// so long that it stands still at a reversal.
void add_hysteresis(std::vector<double>& signal, double half_width, double exponent) {
    const Presliding bristles{.length_m = half_width * std::exp2(exponent), .exponent = exponent};
    double bend = 0.0;
    double before = signal.front();
    for (double& value : signal) {
        const double now = value;
        bend = laws::bristle_after(bristles, bend, now - before).bend;
        before = now;
        value = now - half_width * bend;
    }
}

// Exact for a signal that is straight between its samples.
void add_lag(std::vector<double>& signal, double lag_s, double time_step_s) {
    const double settled = -std::expm1(-time_step_s / lag_s);
    const double of_ramp = lag_s / time_step_s * settled;
    double before = signal.front();
    double reading = before;
    for (double& value : signal) {
        const double now = value;
        reading += settled * (before - reading) + (1.0 - of_ramp) * (now - before);
        before = now;
        value = reading;
    }
}

std::vector<double> delayed(const std::vector<double>& signal, double delay_s, double time_step_s) {
    const double last = static_cast<double>(signal.size() - 1);
    std::vector<double> shifted(signal.size());
    for (std::size_t sample = 0; sample < signal.size(); ++sample) {
        const double at = std::clamp(static_cast<double>(sample) - delay_s / time_step_s, 0.0, last);
        const auto below = std::min(static_cast<std::size_t>(at), signal.size() - 2);
        const double fraction = at - static_cast<double>(below);
        shifted[sample] = (1.0 - fraction) * signal[below] + fraction * signal[below + 1];
    }
    return shifted;
}

}  // namespace

std::vector<double> sensed(std::vector<double> signal, const SensorFaults& faults, double time_step_s,
                           double session_time_s) {
    if (faults.none() || signal.size() < 2) return signal;
    if (faults.hysteresis > 0.0) add_hysteresis(signal, faults.hysteresis, faults.loop_exponent);
    if (faults.lag_s > 0.0) add_lag(signal, faults.lag_s, time_step_s);
    if (faults.delay_s != 0.0) signal = delayed(signal, faults.delay_s, time_step_s);
    for (std::size_t sample = 0; sample < signal.size(); ++sample) {
        double& value = signal[sample];
        value =
            faults.gain * value + faults.zero_at(session_time_s + static_cast<double>(sample) * time_step_s);
        if (faults.limit > 0.0) value = std::clamp(value, -faults.limit, faults.limit);
        if (faults.step > 0.0) value = faults.step * std::round(value / faults.step);
    }
    return signal;
}

const std::vector<SensorFault>& sensor_fault_catalogue() {
    using Size = SensorFault::Size;
    using TypicalOf = SensorFault::TypicalOf;
    static const std::vector<SensorFault> all = {
        {.name = "sensor_gain",
         .title = "sensor gain error",
         .size = Size::either_sign,
         .typical = 1.1,
         .value = &SensorFaults::gain},
        {.name = "sensor_offset",
         .title = "sensor offset",
         .size = Size::either_sign,
         .typical = 0.05,
         .typical_of = TypicalOf::channel_span,
         .value = &SensorFaults::offset},
        {.name = "sensor_offset",
         .variant = "drift",
         .title = "sensor offset",
         .number = "change_in_100_s",
         .size = Size::either_sign,
         .typical = 0.05,
         .typical_of = TypicalOf::channel_span,
         .value = &SensorFaults::drift_by_100_s},
        {.name = "sensor_lag",
         .title = "sensor lag",
         .unit = "s",
         .typical = 0.03,
         .value = &SensorFaults::lag_s,
         .confusable_with = {"time_misalignment"}},
        {.name = "time_misalignment",
         .title = "time misalignment",
         .unit = "s",
         .size = Size::either_sign,
         .typical = 3.0,
         .typical_of = TypicalOf::time_step,
         .value = &SensorFaults::delay_s},
        {.name = "sensor_quantization",
         .title = "sensor quantisation",
         .size = Size::lattice,
         .typical = 0.05,
         .typical_of = TypicalOf::channel_span,
         .value = &SensorFaults::step},
        {.name = "sensor_clipping",
         .title = "sensor clipping",
         .number = "limit",
         .size = Size::limit,
         .typical_of = TypicalOf::channel_span,
         .value = &SensorFaults::limit,
         .answered_as = "unknown"},
        {.name = "sensor_hysteresis",
         .title = "sensor hysteresis",
         .typical = 0.03,
         .typical_of = TypicalOf::channel_span,
         .value = &SensorFaults::hysteresis,
         // From nearly a play to a loop that closes more slowly than an exponential.
         .shape = {"loop_exponent", 1e-3, 2.0, &SensorFaults::loop_exponent}},
    };
    return all;
}

}  // namespace capstan
