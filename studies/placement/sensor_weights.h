#pragma once

#include <vector>

#include "capstan/placement/prepared_study.h"

namespace capstan {

/// Weights of the W methods for one scenario: 1 / (mean single-sensor error), the mean taken over the
/// scenarios that the plan names as source. `errors_N` is scenarios x nodes.
std::vector<double> sensor_weights(const PreparedStudy& study,
                                   const std::vector<std::vector<double>>& errors_N, int scenario_index);

}  // namespace capstan
