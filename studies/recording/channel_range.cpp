#include "capstan/recording/channel_range.h"

#include <algorithm>
#include <cmath>

namespace capstan {

ValueRange range_of(const std::vector<double>& values) {
    if (values.empty()) return {};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high};
}

ValueRange range_of(const Recording& recording, std::size_t channel) {
    ValueRange range = range_of(recording.runs.front().values[channel]);
    for (const RecordedRun& run : recording.runs) {
        const ValueRange of_run = range_of(run.values[channel]);
        range = {std::min(range.low, of_run.low), std::max(range.high, of_run.high)};
    }
    return range;
}

double largest_span(const Recording& recording, std::size_t channel) {
    double span = 0.0;
    for (const RecordedRun& run : recording.runs) span = std::max(span, range_of(run.values[channel]).span());
    return span;
}

namespace {

// The step of a lattice of sorted values, no two of them equal. The smallest distance is rounded as the file
// rounds its values; over the distance of the first to each later value, less and less.
double step_of(const std::vector<double>& values) {
    double step = values.back() - values.front();
    for (std::size_t k = 1; k < values.size(); ++k) step = std::min(step, values[k] - values[k - 1]);
    for (const double value : values) {
        const double distance = value - values.front();
        if (distance > 0.0) step = distance / std::round(distance / step);
    }
    return step;
}

}  // namespace

std::optional<double> unstated_step(const Recording& recording, std::size_t channel) {
    constexpr double tolerance = 0.02;  // of a step, for what the file rounds
    // Where the step of the sensor is not stated, the decimals of the file are a lattice of many values.
    constexpr std::size_t samples_per_value = 10;
    const Channel& described = recording.channels[channel];
    std::vector<double> values;
    for (const RecordedRun& run : recording.runs)
        values.insert(values.end(), run.values[channel].begin(), run.values[channel].end());
    const std::size_t samples = values.size();
    if (samples == 0) return {};
    std::sort(values.begin(), values.end());
    const double rounding = 1e-9 * (values.back() - values.front());
    values.erase(
        std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a <= rounding; }),
        values.end());
    if (values.size() < 3 || (!described.step && values.size() * samples_per_value > samples)) return {};
    const double step = step_of(values);
    if (step < 1.5 * std::max(described.step.value_or(0.0), described.noise_std.value_or(0.0))) return {};
    for (const double value : values) {
        const double off = (value - values.front()) / step;
        if (std::abs(off - std::round(off)) > tolerance) return {};
    }
    return step;
}

}  // namespace capstan
