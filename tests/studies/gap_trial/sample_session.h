#pragma once

#include <cmath>
#include <numbers>

#include "capstan/gap_trial/visibility.h"

namespace capstan::gap_trial {

/// A short session of a bench: torque against a lock and a moved handle, or a single cable moved to and fro.
inline std::vector<TrialRun> sample_session(const TrialBench& bench) {
    const auto sine = [](double amplitude, double frequency_Hz, double duration_s) {
        std::vector<double> values;
        for (int k = 0; k <= duration_s * fine_rate_Hz; ++k)
            values.push_back(amplitude * std::sin(2.0 * std::numbers::pi * frequency_Hz * k / fine_rate_Hz));
        return values;
    };
    if (!bench.is_pair()) {
        TrialRun run{.protocol = "single_sine", .pretension_N = 25.0, .driven = {"motor_angle"}};
        run.motor_angle_rad = sine(0.4, 0.8, 2.5);
        return {run};
    }
    TrialRun locked{.protocol = "ramp_locked", .pretension_N = 6.0, .driven = {"motor_torque", "load_angle"}};
    locked.motor_torque_Nm = sine(0.12, 0.8, 2.5);
    locked.load_angle_rad.assign(locked.motor_torque_Nm.size(), 0.0);
    TrialRun moved{.number = 2,
                   .protocol = "sines",
                   .session_start_s = 5.0,
                   .pretension_N = 6.0,
                   .output = OutputKind::handle,
                   .driven = {"motor_torque", "load_angle"}};
    moved.load_angle_rad = sine(0.2, 0.8, 2.5);
    moved.motor_torque_Nm.assign(moved.load_angle_rad.size(), 0.0);
    return {locked, moved};
}

inline SensedSession sensed_with(const TrialBench& bench, const std::vector<TrialRun>& runs,
                                 const TrueEffects& effects) {
    return sense_session(bench, run_session(bench, runs, effects), effects);
}

}  // namespace capstan::gap_trial
