#include "capstan/recording/channel_range.h"

#include <algorithm>

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

}  // namespace capstan
