#pragma once

#include <algorithm>
#include <vector>

namespace capstan {

/// Half width of a two-sided 95% interval, in standard deviations of a normal distribution.
inline constexpr double two_sided_95 = 1.959964;

/// The mean of at least one value.
inline double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// The middle value of at least one; of an even number the upper of the two in the middle, so that the result
/// is always one of the values.
inline double upper_median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The middle value; of an even number the mean of the two in the middle; 0 without any value.
inline double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const double upper = upper_median(values);
    if (values.size() % 2 == 1) return upper;
    std::sort(values.begin(), values.end());
    return 0.5 * (values[values.size() / 2 - 1] + upper);
}

}  // namespace capstan
