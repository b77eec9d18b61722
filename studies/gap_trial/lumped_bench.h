#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/gap_trial/trial_bench.h"
#include "capstan/gap_trial/trial_motion.h"
#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

struct LumpedBenchOptions {
    int masses = 60;  ///< of a cable
    double damping_s = 1e-5;
    /// In place of it, as a fraction of the longest stable time step, for cables of any length and stiffness:
    /// above about 1 the chain is unstable. 0: not used.
    double damping_fraction = 0.0;
    /// Losses of a wire rope at the frequencies of the rotor on its cables (20 to 60 Hz); the oscillation
    /// decays in 0.1 s.
    double loss_stiffness_ratio = 0.3;
    double loss_time_s = 3e-3;
    /// The fraction of static friction beyond dynamic friction that holds a mass at rest. In a continuum the
    /// front of a motion has no width and static friction has almost no effect. A chain of masses delays each
    /// front: all of static friction shifts torques by 6% with 60 masses and by less than 3% with 160.
    double static_fraction = 0.1;
};

/// The true signals of a run at fine_rate_Hz. Torques and tensions oscillate, so they are means over the
/// steps of a sample.
struct TrueRun {
    std::vector<std::vector<double>> values;  // channels (as of the bench) x fine samples
    std::map<std::string, double> conditions;
};

/// Simulates a run on the true bench, from rest at its pretension, under the run's conditions.
TrueRun run_lumped_bench(const TrialBench& bench, const TrialRun& run, const TrueEffects& effects,
                         const LumpedBenchOptions& options = {});

}  // namespace capstan::gap_trial
