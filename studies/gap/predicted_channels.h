#pragma once

#include <optional>
#include <string_view>

#include "capstan/gap/twin.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// Reads a run's inputs by channel name and collects what a model predicts for its other channels.
class PredictedChannels {
  public:
    PredictedChannels(const Recording& recording, const RecordedRun& run, const DrivenInputs& inputs)
        : recording_(recording), run_(run), inputs_(inputs) {
        twin_.values.resize(recording.channels.size());
    }

    /// The channel's input at a sample; the channel must be driven.
    double driven(std::string_view channel, int sample) const {
        const auto index = static_cast<std::size_t>(*recording_.channel(channel));
        return inputs_.values[index][static_cast<std::size_t>(sample)];
    }

    /// Puts a prediction where the recording has such a channel and does not drive it.
    void predict(std::string_view channel, int sample, double value) {
        const std::optional<int> index = recording_.channel(channel);
        if (!index || run_.drives(channel)) return;
        std::vector<double>& values = twin_.values[static_cast<std::size_t>(*index)];
        if (values.empty()) values.resize(run_.time_s.size());
        values[static_cast<std::size_t>(sample)] = value;
    }

    void count_unsolved() { ++twin_.unsolved_steps; }
    TwinRun take() { return std::move(twin_); }

  private:
    const Recording& recording_;
    const RecordedRun& run_;
    const DrivenInputs& inputs_;
    TwinRun twin_;
};

}  // namespace capstan::gap
