#pragma once

#include <cmath>

namespace capstan {

/// Torque ripple of the motor, periodic in its angle (E28); adds to what the motor must give.
struct MotorCogging {
    double sine_Nm = 0.0;
    double cosine_Nm = 0.0;
    double periods_per_turn = 7.0;

    double torque_Nm(double angle_rad) const {
        const double phase = periods_per_turn * angle_rad;
        return sine_Nm * std::sin(phase) + cosine_Nm * std::cos(phase);
    }
    double slope_Nm_per_rad(double angle_rad) const {
        const double phase = periods_per_turn * angle_rad;
        return periods_per_turn * (sine_Nm * std::cos(phase) - cosine_Nm * std::sin(phase));
    }
};

}  // namespace capstan
