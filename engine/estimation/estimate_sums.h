#pragma once

#include <array>
#include <span>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

/// Sums over the estimates that a vote uses, at every node.
struct EstimateSums {
    double weight = 0.0;                                      ///< of all used estimates
    std::array<double, max_estimated_nodes> all_N;            // nodes: weight times tension
    std::array<double, max_estimated_nodes> agreeing_N;       // nodes: of those that agree there
    std::array<double, max_estimated_nodes> agreeing_weight;  // nodes
};

/// Writes the average of the sensors' profiles, weighted by `weight` (nodes), or equally where that is empty.
void average_profiles(const SensorEstimates& estimates, std::span<const int> sensors,
                      std::span<const double> weight, std::span<double> tension_N);

/// Everything that leaving out those who disagree needs.
EstimateSums sum_estimates(const FusionInput& input, std::span<const double> weight);

}  // namespace capstan
