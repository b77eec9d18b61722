#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capstan/recording/recording.h"
#include "capstan/simple_models/modelled_output.h"

namespace capstan::simple_models {

/// A model of one channel without a bench: what any explanation of a gap has to beat.
struct SimpleModel {
    std::string name;         ///< in JSON
    std::string title;        ///< for people
    std::string heading;      ///< the same in a word, above a column
    std::string formula;      ///< in words
    std::size_t numbers = 0;  ///< that were fitted
    ModelledOutput channels;
    double fitted_rms = 0.0;  ///< over the scored samples of the runs that it was fitted to
    /// The output at every sample of a run with the same channels.
    std::function<std::vector<double>(const RecordedRun&)> predict;
};

/// Fits every simple model of a channel to all runs of a recording: constant, linear, closed form (one stop
/// operator), Prandtl-Ishlinskii times load (nine), elastic-plastic elements. Where several choices of motion
/// and load are possible, each model takes the one that fits best. Empty if no channel drives every run, or
/// no run is long enough to be scored.
std::vector<SimpleModel> fit_simple_models(const Recording& recording, std::size_t output);

/// RMS of measured minus `predicted` over the scored samples of a run.
double scored_rms(const RecordedRun& run, std::size_t output, const std::vector<double>& predicted);

}  // namespace capstan::simple_models
