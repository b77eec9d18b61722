#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace capstan::simple_models {

/// Thresholds of the stop operators, as fractions of the motion's range.
inline constexpr std::array stop_thresholds = {0.005, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3};

/// An elastic-perfectly-plastic element (E50): follows the motion from zero, held within +- `limit`, and
/// divided by it. After a reversal it turns from -1 to 1 within twice the limit.
Eigen::VectorXd stop_operator(std::span<const double> motion, double limit);

}  // namespace capstan::simple_models
