#pragma once

#include <vector>

#include "capstan/placement/prepared_study.h"

namespace capstan {

/// Whether the errors of one scenario are a source of the weights of another.
bool gives_weights(const PreparedStudy& study, int source_index, int fused_index);

/// Weights of the W methods for one scenario: 1 / (mean single-sensor error), the mean taken over the
/// scenarios that the plan names as source. `errors_N` is scenarios x nodes; only the
/// sources are read.
std::vector<double> sensor_weights(const PreparedStudy& study,
                                   const std::vector<std::vector<double>>& errors_N, int scenario_index);

}  // namespace capstan
