#include "capstan/bench/bench_plan.h"

#include <cmath>

namespace capstan::bench {

int BenchPlan::samples() const {
    return static_cast<int>(std::lround(duration_s * sample_rate_Hz));
}

PullPullInputs BenchPlan::inputs_at(double time_s) const {
    PullPullInputs inputs;
    const double motor_value = motor.at(time_s);
    if (motor_drive == MotorDrive::torque) {
        inputs.motor = MotorTorque{motor_value};
    } else {
        inputs.motor = MotorAngle{motor_value};
    }
    switch (load_kind) {
        case LoadKind::locked:
            inputs.load = LoadAngle{0.0};
            break;
        case LoadKind::handle:
            inputs.load = LoadAngle{load.at(time_s)};
            break;
        case LoadKind::torque:
            inputs.load = LoadTorque{load.at(time_s)};
            break;
        case LoadKind::spring:
            inputs.load = LoadSpring{load_stiffness_Nm_per_rad, load.at(time_s)};
            break;
    }
    return inputs;
}

}  // namespace capstan::bench
