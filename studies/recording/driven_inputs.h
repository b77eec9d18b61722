#pragma once

#include <vector>

#include "capstan/recording/recording.h"

namespace capstan {

/// The channels of a run that drive a model, freed of noise and encoder steps: friction has a memory, so
/// noise on an input makes a model creep, and one encoder step at a reversal is newtons of tension.
struct DrivenInputs {
    std::vector<std::vector<double>> values;  // channels x samples; empty where not driven
};

/// Each sample from a parabola through the samples around it, the window as wide as the parabola explains
/// them to about their noise: wide on ramps and dwells, narrow at corners and fast motion, none where nothing
/// fits. A locked load stays where it is in the median.
DrivenInputs driven_inputs(const Recording& recording, const RecordedRun& run);

/// Standard deviation of a channel's samples: the noise stated and the rounding to encoder steps; 0 if
/// neither is.
double sample_noise(const Channel& channel);

/// The median; with an even number of values the larger of the middle two. Not for an empty list.
double upper_median(std::vector<double> values);

/// The smoothing itself, for samples with this noise.
std::vector<double> smoothed(const std::vector<double>& samples, double noise_std);

}  // namespace capstan
