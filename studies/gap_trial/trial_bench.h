#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/gap_trial/trial_stream.h"
#include "capstan/recording/recording.h"

namespace capstan::gap_trial {

/// The benches of a trial, of very different friction: 7.1, 2.9, 2.9 and 2.5 rad of wrap.
enum class BenchKind { uniform_tight, uniform_wide, one_bend, single_cable };

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

    bool is_pair() const { return kind != BenchKind::single_cable; }
    double length_m() const;
    /// Columns of a recording: motor_torque, motor_angle, load_angle, load_torque, tensions.
    std::vector<std::string> channels() const;
};

/// `noise_factor` on every channel's noise. Where its tension sensors sit (a single cable has five, a third
/// of the pairs three on cable A) is drawn.
TrialBench make_trial_bench(BenchKind kind, double noise_factor, TrialStream& draws);

}  // namespace capstan::gap_trial
