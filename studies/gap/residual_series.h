#pragma once

#include <vector>

#include "capstan/gap/effects_twin.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// Residuals of one channel in one run.
struct ResidualSeries {
    std::size_t run = 0;
    std::size_t channel = 0;
    int first_sample = 0;       ///< of those predicted; before it lies the first loading from rest
    double scale = 1.0;         ///< noise and the model's floor together, in the channel's unit
    std::size_t first_row = 0;  // in a vector of all residuals
    std::size_t rows = 0;
};

/// Of every channel that the twin predicts, run by run.
std::vector<ResidualSeries> residual_series(const Recording& recording, const EffectsTwin& twin);

}  // namespace capstan::gap
