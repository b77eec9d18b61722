#pragma once

#include <span>
#include <vector>

#include "capstan/estimation/single_sensor.h"
#include "capstan/sensing/noise.h"

namespace capstan {

/// The smallest mean absolute error over nodes [N] that an unbiased estimate with the direction known can
/// have (E13): Cramer-Rao for the one scale that the readings determine, times sqrt(2 / pi) for a Gaussian's
/// mean absolute value. `branch` holds each sensor's known-direction branch, empty where its node rests.
/// Infinite if no sensor of the set moves.
///
/// With the direction unknown the truth sits at a kink of the feasible curve and no such bound applies: this
/// is a line to compare with, not a limit.
double known_direction_bound_N(std::span<const std::optional<SensorBranch>> branch,  // nodes
                               std::span<const double> true_tension_N,               // nodes
                               std::span<const int> sensors, const NoiseLevel& noise);

}  // namespace capstan
