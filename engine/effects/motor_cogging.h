#pragma once

#include <cmath>

#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Torque ripple of the motor, periodic in its angle (E28); adds to the torque that the motor must give. Its
/// second harmonic makes it uneven, as magnets and slots with edges do.
struct MotorCogging {
    double sine_Nm = 0.0;
    double cosine_Nm = 0.0;
    double periods_per_turn = 7.0;
    double second_sine_Nm = 0.0;
    double second_cosine_Nm = 0.0;

    Torque torque(double angle_rad) const {
        if (sine_Nm == 0.0 && cosine_Nm == 0.0 && second_sine_Nm == 0.0 && second_cosine_Nm == 0.0) return {};
        const double phase = periods_per_turn * angle_rad;
        const double sine = std::sin(phase);
        const double cosine = std::cos(phase);
        const double second_sine = 2.0 * sine * cosine;
        const double second_cosine = cosine * cosine - sine * sine;
        return {sine_Nm * sine + cosine_Nm * cosine + second_sine_Nm * second_sine +
                    second_cosine_Nm * second_cosine,
                periods_per_turn * (sine_Nm * cosine - cosine_Nm * sine +
                                    2.0 * (second_sine_Nm * second_cosine - second_cosine_Nm * second_sine))};
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
                             &MotorCogging::periods_per_turn},
                            {{.name = "second_sine",
                              .unit = "N m",
                              .low = -10.0,
                              .high = 10.0,
                              .typical = 0.002,
                              .is_detail = true},
                             &MotorCogging::second_sine_Nm},
                            {{.name = "second_cosine",
                              .unit = "N m",
                              .low = -10.0,
                              .high = 10.0,
                              .typical = 0.002,
                              .is_detail = true},
                             &MotorCogging::second_cosine_Nm}}}};
    }
};

}  // namespace capstan
