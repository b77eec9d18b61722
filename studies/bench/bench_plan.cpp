#include "capstan/bench/bench_plan.h"

#include <cmath>

namespace capstan::bench {

namespace {

using Problems = std::vector<KeyProblem>;

// A larger number is most likely a typing error.
constexpr double max_samples = 1e7;

void check_sines(const std::string& section, const Waveform& wave, Problems& problems) {
    if (wave.kind != WaveformKind::sines) return;
    const auto same_count = [&](const char* name, std::size_t count) {
        if (count == wave.amplitudes.size()) return;
        problems.push_back({section + "." + name, "has " + std::to_string(count) + " numbers for " +
                                                      std::to_string(wave.amplitudes.size()) +
                                                      " amplitudes; give one for each sine"});
    };
    same_count("frequencies_Hz", wave.frequency_Hz.size());
    same_count("phases_rad", wave.phase_rad.size());
}

}  // namespace

Problems problems_of(const BenchPlan& plan) {
    Problems problems;
    for (const KeyProblem& problem : capstan::problems_of(plan.cable))
        problems.push_back({"cable." + problem.key, problem.message});
    if (plan.motor_drive == MotorDrive::torque && plan.load_kind == LoadKind::torque) {
        problems.push_back(
            {"load.input",
             "is \"torque\" and so is the motor's; nothing determines where the pulleys are: drive "
             "the motor by its angle, or let the load be a spring"});
    }
    if (plan.duration_s * plan.sample_rate_Hz > max_samples) {
        problems.push_back(
            {"duration_s", "makes more than ten million samples; shorten it or lower sample_rate_Hz"});
    }
    check_sines("motor", plan.motor, problems);
    if (plan.load_kind != LoadKind::locked) check_sines("load", plan.load, problems);
    return problems;
}

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
