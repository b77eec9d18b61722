#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/gap_trial/trial_stream.h"
#include "capstan/recording/recording.h"

namespace capstan::gap_trial {

/// The benches of a trial, of very different friction: 7.1, 2.9, 2.9 and 2.5 rad of wrap.
/// `rig_` kinds have a geometry of their own in each case: a pair, a single cable, a drive of unknown
/// geometry.
enum class BenchKind { uniform_tight, uniform_wide, one_bend, single_cable, rig_pair, rig_single, rig_drive };

inline constexpr BenchKind all_bench_kinds[] = {BenchKind::uniform_tight, BenchKind::uniform_wide,
                                                BenchKind::one_bend, BenchKind::single_cable};

/// "uniform_tight" and so on.
std::string bench_kind_name(BenchKind kind);

/// A bench and what the laboratory states about it.
struct TrialBench {
    BenchKind kind = BenchKind::uniform_wide;
    NominalBench nominal;
    double cable_mass_kg_per_m = 0.006;
    std::map<std::string, double> noise_std;     // by channel, as the lab states it
    std::map<std::string, double> encoder_step;  // by channel
    std::vector<TensionSensor> tension_sensors;
    /// The engine's error without any effect, by channel; empty for the benches whose floor was measured.
    std::map<std::string, double> floor;
    int logged_rate_Hz = 200;
    // Of a drive: the signs of its sensors, as its laboratory mounted them.
    double load_angle_sign = 1.0;
    double load_torque_sign = 1.0;
    double load_angle_zero_rad = 0.0;

    bool is_pair() const { return kind != BenchKind::single_cable && kind != BenchKind::rig_single; }
    bool is_drive() const { return kind == BenchKind::rig_drive; }
    double length_m() const;
    /// Columns of a recording: motor_torque, motor_angle, load_angle, load_torque, tensions.
    std::vector<std::string> channels() const;
};

/// `noise_factor` on every channel's noise. Where its tension sensors sit (a single cable has five, a third
/// of the pairs three on cable A) is drawn.
TrialBench make_trial_bench(BenchKind kind, double noise_factor, TrialStream& draws);

}  // namespace capstan::gap_trial
