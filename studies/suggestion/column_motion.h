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

/// The channels of a drive as its columns' motion shows them; null where no column is left.
struct ColumnsByMotion {
    const SeenColumn* motor_angle = nullptr;
    const SeenColumn* load_angle = nullptr;
    const SeenColumn* motor_torque = nullptr;
    const SeenColumn* load_torque = nullptr;
    double angles_alike = 0.0;  ///< the correlation of the two angles
};

/// The two angles that move together most, and the torques with the widest loops over the motor's angle.
/// Which of the angles is the motor's is the order of the columns. Nothing without an angle.
ColumnsByMotion columns_by_motion(const std::vector<const SeenColumn*>& columns);

}  // namespace capstan::imports
