#include "capstan/effects/sensor_faults.h"

#include <algorithm>
#include <array>
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

// E66. A signal between two of its samples: the cubic that passes through both, with the slopes that the
// neighbours give (Catmull and Rom). Straight lines would make a lag and a delay of less than a sample the
// same filter.
class BetweenSamples {
  public:
    BetweenSamples(const std::vector<double>& signal, std::size_t sample)
        : BetweenSamples(signal[sample], signal[sample + 1], slope(signal, sample),
                         slope(signal, sample + 1)) {}

    double at(double fraction) const {
        return first_ + fraction * (linear_ + fraction * (square_ + fraction * cube_));
    }
    /// The mean with weights: moments[i] is that of fraction^i.
    double mean(const std::array<double, 4>& moments) const {
        return moments[0] * first_ + moments[1] * linear_ + moments[2] * square_ + moments[3] * cube_;
    }

  private:
    BetweenSamples(double first, double second, double first_slope, double second_slope)
        : first_(first), linear_(first_slope) {
        const double rise = second - first;
        square_ = 3.0 * rise - 2.0 * first_slope - second_slope;
        cube_ = first_slope + second_slope - 2.0 * rise;
    }

    // Per sample.
    static double slope(const std::vector<double>& signal, std::size_t sample) {
        const std::size_t before = sample == 0 ? 0 : sample - 1;
        const std::size_t after = std::min(sample + 1, signal.size() - 1);
        return (signal[after] - signal[before]) / static_cast<double>(after - before);
    }

    double first_;
    double linear_;
    double square_;
    double cube_;
};

// What a first-order low-pass makes of fraction^i by the end of a sample of `ratio` time constants:
// the integral of ratio exp(-ratio (1 - fraction)) fraction^i.
std::array<double, 4> low_passed_powers(double ratio) {
    std::array<double, 4> moments{};
    moments[0] = -std::expm1(-ratio);
    if (ratio > 1.0) {
        for (std::size_t i = 1; i < moments.size(); ++i)
            moments[i] = 1.0 - static_cast<double>(i) / ratio * moments[i - 1];
        return moments;
    }
    // Upwards the rounding would grow by 1 / ratio each time; downwards it shrinks.
    double term = ratio / 4.0;
    for (int n = 1; std::abs(term) > 1e-18; ++n) {
        moments[3] += term;
        term *= -ratio / (n + 4.0);
    }
    for (std::size_t i = 3; i > 1; --i) moments[i - 1] = (1.0 - moments[i]) * ratio / static_cast<double>(i);
    return moments;
}

void add_lag(std::vector<double>& signal, double lag_s, double time_step_s) {
    const std::vector<double> original = signal;
    const std::array<double, 4> moments = low_passed_powers(time_step_s / lag_s);
    const double kept = 1.0 - moments[0];
    for (std::size_t sample = 1; sample < signal.size(); ++sample)
        signal[sample] = kept * signal[sample - 1] + BetweenSamples(original, sample - 1).mean(moments);
}

std::vector<double> delayed(const std::vector<double>& signal, double delay_s, double time_step_s) {
    const double last = static_cast<double>(signal.size() - 1);
    std::vector<double> shifted(signal.size());
    for (std::size_t sample = 0; sample < signal.size(); ++sample) {
        const double at = std::clamp(static_cast<double>(sample) - delay_s / time_step_s, 0.0, last);
        const auto below = std::min(static_cast<std::size_t>(at), signal.size() - 2);
        shifted[sample] = BetweenSamples(signal, below).at(at - static_cast<double>(below));
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
         .shape = {"loop_exponent", 1e-3, 2.0, &SensorFaults::loop_exponent},
         .confusable_with = {"pulley_friction"}},
    };
    return all;
}

}  // namespace capstan
