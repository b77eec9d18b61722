#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/calibration/twin.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

struct CalibrationOptions {
    std::vector<std::string> fitted;  ///< names of parameters to fit; empty: all of the twin's
    int segments = twin_segments;
    int threads = 0;  ///< 0: as many as the machine has
    /// Where the search starts, by the names of parameters; positive. Others start at their nominal values.
    std::map<std::string, double> start{};
};

/// The estimate of one parameter from a recording.
struct ParameterEstimate {
    TwinParameter parameter;
    double value = 0.0;  ///< the nominal one where nothing else is known
    double low = 0.0;    ///< 95% interval
    double high = 0.0;
    bool fitted = true;        ///< asked for
    bool identifiable = true;  ///< the recording determines it; else it stays at its nominal value
    std::string reason;        ///< why it is not, or which other parameter it trades with
};

/// RMS of measured minus model in one channel of one run, in the channel's unit.
struct ChannelFit {
    int run = 0;
    std::string channel;
    std::string unit;
    double noise = 0.0;  ///< of one sample, as the sidecar says; 0: not stated
    double nominal_rms = 0.0;
    double calibrated_rms = 0.0;  ///< with the parameters fitted to all runs
    double held_out_rms = 0.0;    ///< with those fitted without this run
    bool held_out = false;        ///< there was another run to fit to
};

struct Calibration {
    std::vector<ParameterEstimate> parameters;
    std::vector<ChannelFit> channels;  // runs x predicted channels
    bool converged = false;
    int unsolved_steps = 0;  ///< of the calibrated twin
    int evaluations = 0;     ///< of the twin over a set of runs

    std::vector<double> values() const;
};

/// Fits a twin's parameters to a recording by least squares on their logarithms, each channel of each run in
/// units of what the fit leaves in it (its noise and the model's own floor).
///
/// Intervals: the larger of two estimates for residuals that are correlated in time and within a run: the
/// sandwich over blocks of a second, and the jackknife over runs. A parameter whose interval spans more than
/// a factor of two either way is not identifiable and stays nominal. Held out: each run is predicted with
/// parameters fitted to all others; of a single run nothing is held out.
Calibration calibrate(const Recording& recording, const CalibrationOptions& options);

}  // namespace capstan::gap
