#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "capstan/recording/recording.h"

namespace capstan::simple_models {

/// A drive without a bench: a torque of zero, gain and friction whose yield grows with the load and builds up
/// within a path, over an angle that turns to and fro.
struct RoughDrive {
    double zero_Nm = -0.012;
    double gain = -0.9;
    double yield_Nm = 0.04;
    double yield_per_load = 0.35;
    double built_up_rad = 0.1;  ///< from one direction to the other
    /// Of the element that yields; the friction then builds up within a path that grows with the load. 0: the
    /// path above.
    double stiffness_Nm_per_rad = 0.0;
    double sensor_gain = 1.0;  ///< of the torque channel, to change its unit
};

/// Runs of 4 s at 100 Hz under different loads, each with a slowly varying load.
inline Recording session_of(const RoughDrive& drive, int runs, double first_load_Nm = -0.05) {
    Recording recording;
    recording.name = "rough drive";
    recording.mode = BenchMode::lumped_drive;
    recording.sample_rate_Hz = 100.0;
    for (const char* name : {"motor_angle", "load_torque", "motor_torque"})
        recording.channels.push_back({name, std::string(name).ends_with("torque") ? "N m" : "rad", {}, {}});
    for (int number = 1; number <= runs; ++number) {
        RecordedRun run;
        run.number = number;
        run.driven = {"motor_angle", "load_torque"};
        run.values.resize(3);
        double lag_rad = 0.0;
        double before_rad = 0.0;
        for (int sample = 0; sample < 400; ++sample) {
            const double time_s = 0.01 * sample;
            const double phase = 2.0 * std::numbers::pi * time_s / 1.7;
            const double angle_rad = 0.5 * std::sin(phase) + 0.15 * std::sin(2.3 * phase);
            const double load_Nm = first_load_Nm * number * (1.0 + 0.2 * std::sin(0.7 * phase + number));
            const double yield_Nm = drive.yield_Nm + drive.yield_per_load * std::abs(load_Nm);
            const double limit_rad = drive.stiffness_Nm_per_rad > 0.0 ? yield_Nm / drive.stiffness_Nm_per_rad
                                                                      : 0.5 * drive.built_up_rad;
            lag_rad =
                std::clamp(lag_rad + (sample > 0 ? angle_rad - before_rad : 0.0), -limit_rad, limit_rad);
            before_rad = angle_rad;
            run.time_s.push_back(time_s);
            run.values[0].push_back(angle_rad);
            run.values[1].push_back(load_Nm);
            run.values[2].push_back(drive.sensor_gain *
                                    (drive.zero_Nm + drive.gain * load_Nm + yield_Nm * lag_rad / limit_rad));
        }
        recording.runs.push_back(run);
    }
    return recording;
}

/// The recording with only its runs of odd or of even numbers.
inline Recording with_numbers(Recording recording, int remainder) {
    std::erase_if(recording.runs, [&](const RecordedRun& run) { return run.number % 2 != remainder; });
    return recording;
}

}  // namespace capstan::simple_models
