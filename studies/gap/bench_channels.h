#pragma once

#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::gap {

// What turns a recording of unknown geometry into one of an equivalent bench.

inline constexpr double equivalent_motor_radius_m = 0.02;

/// A pair with one radian of wrap, so that the friction coefficient is the exponent, one metre long, and a
/// motor pulley of 20 mm. `stiffness_Nm_per_rad`: of one cable about the motor pulley.
NominalBench equivalent_pair(double exponent, double stiffness_Nm_per_rad, double load_over_motor_radius);

/// A single cable of that wrap and length between two such pulleys.
NominalBench equivalent_cable(double exponent, double axial_stiffness_N);

std::vector<double> scaled(const std::vector<double>& values, double factor, double offset = 0.0);

/// A recorded channel under another name, in another unit.
Channel scaled_channel(const Recording& recording, const char* from, const char* name, const char* unit,
                       double factor);

/// Adds a load angle that never changes.
void hold_load(Recording& bench);

/// A run's samples of a channel that was recorded.
const std::vector<double>& samples_of(const Recording& recording, std::size_t run, const char* channel);

}  // namespace capstan::gap
