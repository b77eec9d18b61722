#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/gap_trial/trial_bench.h"
#include "capstan/recording/recording.h"

namespace capstan::gap_trial {

/// The rate of motions and of signals before they are logged.
inline constexpr int fine_rate_Hz = 2000;

/// The plan of one run.
struct TrialRun {
    int number = 1;
    std::string protocol{};
    double session_start_s = 0.0;
    double pretension_N = 0.0;  ///< as the laboratory sets it
    OutputKind output = OutputKind::locked;
    std::vector<std::string> driven{};
    std::map<std::string, double> conditions{};  ///< as the sidecar states them, such as roll_deg
    // Fine samples: motor_torque [N m] and load_angle [rad] of a pair; motor_angle [rad] of a single cable;
    // motor_angle [rad] and load_torque [N m] of a drive.
    std::vector<double> motor_torque_Nm{};
    std::vector<double> load_angle_rad{};
    std::vector<double> motor_angle_rad{};
    std::vector<double> load_torque_Nm{};

    double duration_s() const;
};

enum class RecordingLength {
    standard,  ///< all protocols of the bench
    brief,     ///< one or two
};

/// The runs of a session, two seconds between them: levels, strokes and speeds are drawn.
std::vector<TrialRun> draw_session(const TrialBench& bench, RecordingLength length, TrialStream& draws);

/// Numbers the runs of a session from 1, and puts them one after the other with a pause between.
void number_runs(std::vector<TrialRun>& runs, double pause_s);

}  // namespace capstan::gap_trial
