#pragma once

#include <vector>

#include "capstan/suggestion/column_roles.h"

namespace capstan::imports {

/// Pearson's correlation of the samples that both have; 0 where one of them does not move.
double correlation(const std::vector<double>& a, const std::vector<double>& b);

/// The work of a torque about its mean over an angle, in the product of their units. Over closed loops it is
/// positive where the torque drives against friction.
double loop_work(const std::vector<double>& torque, const std::vector<double>& angle);

/// An angle changes smoothly from reading to reading, or by the steps of an encoder; a load cell is noisy.
bool looks_like_angle(const SeenColumn& column);

}  // namespace capstan::imports
