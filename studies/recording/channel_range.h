#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan {

/// The smallest and the largest value, in their unit.
struct ValueRange {
    double low = 0.0;
    double high = 0.0;

    double span() const { return high - low; }
    double middle() const { return 0.5 * (low + high); }
};

/// Of no values: from 0 to 0.
ValueRange range_of(const std::vector<double>& values);

/// Of a channel over all runs.
ValueRange range_of(const Recording& recording, std::size_t channel);

/// Of a channel in the run where it moves most.
double largest_span(const Recording& recording, std::size_t channel);

/// The step on which all values of a channel lie, if it is coarser than the noise and step that the sidecar
/// states; none if the values lie anywhere.
std::optional<double> unstated_step(const Recording& recording, std::size_t channel);

}  // namespace capstan
