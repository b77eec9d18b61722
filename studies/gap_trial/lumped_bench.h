#pragma once

#include <vector>

#include "capstan/gap_trial/trial_bench.h"
#include "capstan/gap_trial/trial_motion.h"
#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

struct LumpedBenchOptions {
    int masses = 60;  ///< of a cable
    double damping_s = 1e-5;
    /// Losses of a wire rope where the rotor rings on its cables (20 to 60 Hz); it dies out in 0.1 s.
    double loss_stiffness_ratio = 0.3;
    double loss_time_s = 3e-3;
    /// How much of static friction beyond dynamic friction holds a mass at rest. In a continuum the front of
    /// a motion has no width and static friction hardly matters; lumps make each front wait for it, which
    /// with all of it shifts torques by 6% at 60 masses and by less than half of that at 160.
    double static_fraction = 0.1;
};

/// What happened in a run, every 1 / fine_rate_Hz: means over the steps between for torques and tensions,
/// which ring.
struct TrueRun {
    std::vector<std::vector<double>> values;  // channels (as of the bench) x fine samples
};

/// A run on a bench as it truly is, from rest at its pretension.
TrueRun run_lumped_bench(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                         const LumpedBenchOptions& options = {});

}  // namespace capstan::gap_trial
