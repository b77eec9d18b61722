#pragma once

#include "capstan/gap/effects_twin.h"
#include "sample_recording.h"

namespace capstan::gap {

/// driven_session() as a bench with these numbers measures it, without noise, on the model's own segments:
/// the model with the same numbers leaves nothing.
inline Recording exact_session(const BenchNumbers& numbers, const EffectsTwinOptions& options) {
    Recording recording = driven_session();
    for (Channel& channel : recording.channels) channel.step.reset();
    const EffectsTwin bench(recording, options);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        TwinRun truth = bench.run(run, numbers);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (!truth.values[channel].empty())
                recording.runs[run].values[channel] = std::move(truth.values[channel]);
        }
    }
    return recording;
}

inline constexpr EffectsTwinOptions coarse_twin{.segments = 24, .stride = 1};

}  // namespace capstan::gap
