#pragma once

#include <vector>

#include "capstan/worlds/world_study.h"

namespace capstan {

/// Mean with Student's t interval at 1 - alpha. At least two values.
Estimated mean_of(const std::vector<double>& values, double alpha = 0.05);

/// The value that `fraction` of the values stay below, interpolated between order statistics.
double quantile_of(std::vector<double> values, double fraction);

/// By how much the quantile at `at_N` of errors falls where each world's error falls from `from_N` to `to_N`:
/// a quantile moves as the worlds near it do in the mean, here by linear regression over all of them.
double fall_near(double at_N, const std::vector<double>& from_N, const std::vector<double>& to_N);

/// What each world adds to an objective: its error, or of a quantile the pseudo-values of leaving out blocks
/// of worlds. Their mean is the objective, to first order.
std::vector<double> contributions(PlacementObjective objective, const std::vector<double>& values);

/// a - b, element by element.
std::vector<double> differences(std::vector<double> a, const std::vector<double>& b);

}  // namespace capstan
