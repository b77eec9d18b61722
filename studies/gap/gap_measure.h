#pragma once

#include <string>
#include <vector>

#include "capstan/gap/cause_fit.h"
#include "capstan/gap/gap_map.h"

namespace capstan::gap {

/// RMS of measured minus model in one channel, over all samples of all runs that do not drive it.
struct ChannelGap {
    std::string channel;
    std::string unit;
    double noise = 0.0;  ///< of one sample
    double before_rms = 0.0;
    double after_rms = 0.0;
    double held_out_rms = 0.0;   ///< each run or half of it, with numbers fitted to the rest
    double runner_up_rms = 0.0;  ///< with the best other cause instead
    /// Fraction of the closable gap (mean square beyond noise) that is closed on held-out data, with its 95%
    /// interval from a bootstrap over blocks of a second. NaN if nothing exceeds the noise.
    double closed = 0.0;
    double closed_low = 0.0;
    double closed_high = 0.0;
};

/// A part of a recording that is left out of a fit.
struct HeldOut {
    LeftOut left_out;
    BenchNumbers numbers;  ///< as fitted without it
};

/// The models that a recording is measured against.
struct GapModels {
    BenchNumbers leading;
    BenchNumbers runner_up;
    std::vector<HeldOut> held_out;
};

struct GapMeasure {
    std::vector<ChannelGap> channels;
    std::vector<GapFraction> map;         ///< of the nominal model
    std::vector<SampleSorting> sortings;  ///< the samples of the map's parts
    int worst_run = 0;                    ///< where the gap is largest against noise
    std::string worst_channel;
    std::vector<TwinRun> nominal;  ///< runs, at every sample
    std::vector<TwinRun> leading;
};

/// The map counts in the scales of `fitter`.
GapMeasure measure_gap(const Recording& recording, const CauseFitter& fitter, const GapModels& models);

}  // namespace capstan::gap
