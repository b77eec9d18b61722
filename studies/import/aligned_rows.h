#pragma once

#include <functional>
#include <span>
#include <vector>

#include "capstan/import/log_runs.h"

namespace capstan::imports {

/// A stretch of a log that becomes one run of the recording: which rows, from when to when, at which times.
struct Piece {
    std::size_t log_run = 0;  ///< index of the LogRun
    double from_s = 0.0;      ///< on the log's clock
    double to_s = 0.0;
    double grid_Hz =
        0.0;  ///< times of samples: from_s + k / grid_Hz; 0: the times of the first channel's clock
    int thinned_by = 1;  ///< of so many of these samples one is kept
    Thinning thinning = Thinning::pick;
};

/// Calls `row` for each sample of a piece, in order: its time from the piece's beginning, and the value of
/// each source of the run whose index is in `channels`. A sample at which a channel has no value is left out.
/// Returns the number of samples. Means of blocks have the time of the block's first sample.
std::size_t for_each_row(const LogRun& run, const Piece& piece, std::span<const std::size_t> channels,
                         const std::function<void(double time_s, std::span<const double> values)>& row);

}  // namespace capstan::imports
