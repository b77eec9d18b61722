#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/gap_trial/lumped_bench.h"
#include "capstan/gap_trial/trial_stream.h"

namespace capstan::gap_trial {

/// What the laboratory's instruments measure in a run, without noise and steps: faults of sensors, then the
/// 40 Hz zero-phase low-pass of torques and tensions, then samples at the logged rate. channels x samples.
using SensedRun = std::vector<std::vector<double>>;

SensedRun sense(const TrialBench& bench, const TrueRun& run,
                const std::map<std::string, TrueSensorFault>& faults);

/// The same with noise drawn, and rounded to the steps of encoders and faulty converters: what is logged.
SensedRun with_noise(const TrialBench& bench, const SensedRun& run,
                     const std::map<std::string, TrueSensorFault>& faults, TrialStream& draws);

/// A second-order Butterworth filter, forward and backward, so without delay.
void zero_phase_low_pass(std::vector<double>& signal, double cutoff_Hz, double rate_Hz);

}  // namespace capstan::gap_trial
