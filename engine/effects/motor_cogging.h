#pragma once

#include <cmath>

#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Torque ripple of the motor, periodic in its angle (E28); adds to the torque that the motor must give.
struct MotorCogging {
    double sine_Nm = 0.0;
    double cosine_Nm = 0.0;
    double periods_per_turn = 7.0;

    Torque torque(double angle_rad) const {
        if (sine_Nm == 0.0 && cosine_Nm == 0.0) return {};
        const double phase = periods_per_turn * angle_rad;
        const double sine = std::sin(phase);
        const double cosine = std::cos(phase);
        return {sine_Nm * sine + cosine_Nm * cosine,
                periods_per_turn * (sine_Nm * cosine - cosine_Nm * sine)};
    }

    static std::vector<EffectRow<MotorCogging>> rows() {
        return {
            {.about = {.name = "motor_cogging",
                       .title = "motor cogging",
                       .family = "actuator",
                       .component = "motor",
                       .end = "motor",
                       .equation = "E28",
                       .meaning = "torque ripple, periodic in the motor angle"},
             .parameters = {{{.name = "sine", .unit = "N m", .low = -10.0, .high = 10.0, .typical = 0.005},
                             &MotorCogging::sine_Nm},
                            {{.name = "cosine", .unit = "N m", .low = -10.0, .high = 10.0, .typical = 0.005},
                             &MotorCogging::cosine_Nm},
                            {{.name = "periods_per_turn",
                              .low = 1.0,
                              .high = 200.0,
                              .typical = 7.0,
                              .role = ParameterRole::periods},
                             &MotorCogging::periods_per_turn}}}};
    }
};

}  // namespace capstan
