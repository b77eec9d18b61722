#pragma once

#include <vector>

#include "capstan/gap/cause_search.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/recording/recording.h"

namespace capstan::model_comparison {

/// What a model says of a recording, in the recording's own channels, signs and units.
struct Predictions {
    std::vector<std::vector<std::vector<double>>> values;  // runs x channels x samples; empty: not predicted
};

/// All runs of a bench with these numbers, driven as it was recorded.
std::vector<gap::TwinRun> bench_runs(const Recording& bench, const gap::BenchNumbers& numbers,
                                     const gap::CauseSearchOptions& options);

/// Translates what a model of an equivalent bench predicts into the channels of the recording that the bench
/// was made of. `runs`: one for each run of `recording` and `bench`.
Predictions in_recorded_channels(const Recording& recording, const Recording& bench,
                                 const std::vector<gap::TwinRun>& runs);

}  // namespace capstan::model_comparison
