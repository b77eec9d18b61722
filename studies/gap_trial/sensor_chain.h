#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/gap_trial/lumped_bench.h"
#include "capstan/gap_trial/trial_stream.h"

namespace capstan::gap_trial {

/// What the lab's instruments give of a run, without noise and steps: faults of sensors, then the 40 Hz
/// zero-phase low-pass of torques and tensions, then samples at the logged rate. channels x samples.
using SensedRun = std::vector<std::vector<double>>;

SensedRun sense(const TrialBench& bench, const TrueRun& run,
                const std::map<std::string, TrueSensorFault>& faults);

/// The same with noise drawn, and rounded to the steps of encoders and faulty converters: what is logged.
SensedRun with_noise(const TrialBench& bench, const SensedRun& run,
                     const std::map<std::string, TrueSensorFault>& faults, TrialStream& draws);

/// Forward and backward, so without delay: second-order Butterworth each way.
void zero_phase_low_pass(std::vector<double>& signal, double cutoff_Hz, double rate_Hz);

}  // namespace capstan::gap_trial
