#pragma once

#include <vector>

#include "capstan/recording/recording.h"

namespace capstan {

/// The channels of a run that drive a model, without noise and encoder steps: friction has a memory, so
/// noise on an input makes a model creep, and one encoder step at a reversal is newtons of tension.
struct DrivenInputs {
    std::vector<std::vector<double>> values;  // channels x samples; empty where not driven
};

/// Replaces each sample by the value of a parabola through the samples around it. The window is as wide as
/// the parabola fits to about the noise: wide on ramps and dwells, narrow at corners and in fast motion;
/// where no window fits, the sample stays. A locked load stays at the median of its samples.
DrivenInputs driven_inputs(const Recording& recording, const RecordedRun& run);

/// The inputs that another measurement of the same motion could give: `driven_inputs` with fresh noise of each
/// channel, smoothed again. They differ from `driven_inputs` as those do from the true motion. The noise
/// depends on the number of the measurement, the run's number, the channel and the sample alone.
DrivenInputs driven_inputs_again(const Recording& recording, const RecordedRun& run, int measurement);

/// Standard deviation of a channel's samples: the noise stated and the rounding to encoder steps; 0 if
/// neither is.
double sample_noise(const Channel& channel);

/// The smoothing itself, for samples with this noise.
std::vector<double> smoothed(const std::vector<double>& samples, double noise_std);

/// The recording with the noise of every channel stated. Where the sidecar states none, it is estimated from
/// the median second difference of the samples, which slow motion changes little; it is 0 where the stated
/// step of the channel explains that difference.
Recording with_estimated_noise(Recording recording);

}  // namespace capstan
