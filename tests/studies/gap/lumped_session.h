#pragma once

#include <cmath>
#include <numbers>

#include "capstan/recording/recording.h"
#include "capstan/solver/pull_pull.h"

namespace capstan::gap {

/// What a drive of unknown geometry is made of, seen from its shafts.
struct LumpedTruth {
    double friction_exponent = 0.3;
    double stiffness_Nm_per_rad = 3.0;
    double pretension_Nm = 0.5;
    double speed_ratio = 2.0;
    double motor_torque_sign = 1.0;       ///< -1: the instrument counts the other way
    double load_spring_Nm_per_rad = 0.0;  ///< of what holds the load; 0: constant loads
};

/// Two runs of such a drive under different loads, as two cables with one radian of wrap and a motor pulley
/// of one metre.
inline Recording lumped_session(const LumpedTruth& truth) {
    constexpr double sample_rate_Hz = 50.0;
    constexpr double run_s = 3.0;
    constexpr double load_angle_offset_rad = 0.7;  // its zero is not known
    CableSpecification cable;
    cable.curvature = {{1.0, 1.0}};
    cable.segments = 40;
    cable.axial_stiffness_N = truth.stiffness_Nm_per_rad;
    cable.dynamic_friction = cable.static_friction = truth.friction_exponent;
    cable.pretension_N = truth.pretension_Nm;
    const PullPull pair{Cable(cable), Cable(cable), {1.0, truth.speed_ratio}};

    Recording recording;
    recording.name = "drive";
    recording.mode = BenchMode::lumped_drive;
    recording.sample_rate_Hz = sample_rate_Hz;
    for (const char* name : {"motor_torque", "motor_angle", "load_angle", "load_torque"})
        recording.channels.push_back({name, std::string(name).ends_with("torque") ? "N m" : "rad", {}, {}});
    for (const double load_Nm : {0.1, 0.3}) {
        RecordedRun run;
        run.number = static_cast<int>(recording.runs.size()) + 1;
        run.driven = {"motor_angle", "load_torque"};
        run.values.resize(recording.channels.size());
        PullPullState state = pair.at_rest();
        for (int sample = 0; sample < run_s * sample_rate_Hz; ++sample) {
            const double time_s = sample / sample_rate_Hz;
            const double angle_rad = 0.6 * std::sin(2.0 * std::numbers::pi * time_s);
            LoadInput load = LoadTorque{load_Nm};
            if (truth.load_spring_Nm_per_rad > 0.0) load = LoadSpring{truth.load_spring_Nm_per_rad, 0.0};
            pair.advance(state, {MotorAngle{angle_rad}, load});
            run.time_s.push_back(time_s);
            run.values[0].push_back(truth.motor_torque_sign * pair.motor_torque_Nm(state));
            run.values[1].push_back(angle_rad);
            run.values[2].push_back(load_angle_offset_rad + state.load_angle_rad);
            run.values[3].push_back(pair.load_torque_Nm(state));
        }
        recording.runs.push_back(run);
    }
    return recording;
}

}  // namespace capstan::gap
