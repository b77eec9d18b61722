#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::simple_models {

/// A channel that a simple model predicts, and the channels that it predicts it from: a motion, whose
/// reversals it remembers, and a load. Indices in `Recording::channels`.
struct ModelledOutput {
    std::size_t output = 0;
    std::size_t motion = 0;
    std::optional<std::size_t> load{};  ///< none where no second channel is driven
};

/// The channels that a model of the bench would predict and that no run drives; of a band, its two tensions.
std::vector<std::size_t> output_channels(const Recording& recording);

/// The choices of motion and load for an output among the channels that every run drives; empty if there is
/// none that moves. An angle or a displacement is the motion and a torque the load, where there is one of
/// each and the drive's geometry is not known; else every choice is returned, because a locked bench moves
/// by its torque.
std::vector<ModelledOutput> possible_inputs(const Recording& recording, std::size_t output);

/// The first sample of a run that is scored: the motion before a run is unknown, and within this time the
/// first motion has overwritten its effect.
std::size_t first_scored_sample(const RecordedRun& run);

}  // namespace capstan::simple_models
