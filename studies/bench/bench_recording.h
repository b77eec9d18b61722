#pragma once

#include <cstdint>

#include "capstan/bench/bench_run.h"
#include "capstan/plan/study_plan.h"
#include "capstan/recording/recording.h"

namespace capstan::bench {

/// What a laboratory would have recorded.
struct Instruments {
    int tension_sensors = 0;      ///< on each cable, evenly from its motor end to its load end
    double noise_fraction = 0.0;  ///< standard deviation of each channel's noise over the channel's span
    std::uint64_t seed = 1;       ///< of the noise
};

/// Begins a recording of benches of one transmission: its channels and what is known of it. Effects are not
/// known.
Recording empty_recording(const BenchPlan& plan, const Instruments& instruments);

/// Adds an instant of the bench to the recording's last run. `cable`: the plan's.
void record(Recording& recording, const Cable& cable, const BenchInstant& now);

/// Begins the run of a bench. Throws InvalidInput if its transmission or sample rate is not that of the
/// recording.
void begin_run(Recording& recording, const BenchPlan& plan);

/// The motion of a study's single cable, whose far end must be held, as a recording of one run: pulleys of 20
/// mm at both ends. Throws InvalidInput if the far end moves.
Recording recorded_motion(const StudyPlan& plan, const Instruments& instruments);
inline constexpr double recorded_pulley_radius_m = 0.02;

/// White noise on every channel; the recording states it. Draws are addressed by channel, run and sample.
void add_noise(Recording& recording, const Instruments& instruments);

}  // namespace capstan::bench
