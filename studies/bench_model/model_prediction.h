#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/bench_model/bench_model.h"
#include "capstan/model_comparison/bench_predictions.h"

namespace capstan::bench_model {

/// A recording as the model's bench sees it: its channels, with the bench that the model describes. Throws
/// InvalidInput where the recording is of another kind of bench.
Recording recording_of_bench(const BenchModel& model, const Recording& recording);

/// The numbers of the model that concern this recording: without sensors that it does not have.
gap::BenchNumbers numbers_for(const BenchModel& model, const Recording& recording);

/// The errors of one channel in one run, from one second into the run, in the channel's unit.
struct ChannelError {
    std::size_t run = 0;      ///< index
    std::size_t channel = 0;  ///< index
    bool was_fitted = false;  ///< the model's own recording, and a run that it was fitted to
    double span = 0.0;        ///< what the channel covers in the run
    double nominal_rms = 0.0;
    double model_rms = 0.0;
    std::optional<double> with_law_rms;  ///< none: the model has no law for the channel
};

/// What a model says of a recording.
struct ModelPrediction {
    model_comparison::Predictions nominal;   ///< the bench as the recording describes it
    model_comparison::Predictions model;     ///< with what the diagnosis found
    model_comparison::Predictions with_law;  ///< empty where the model has no law for a channel
    std::vector<ChannelError> errors;        ///< runs x predicted channels
    std::vector<std::string> notes;          ///< what a reader must know to judge it; sentences
};

/// Drives the model with the recording's inputs. `threads` as for parallel_for_each_index.
ModelPrediction predict(const BenchModel& model, const Recording& recording, int threads);

}  // namespace capstan::bench_model
