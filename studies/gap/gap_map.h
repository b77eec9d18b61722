#pragma once

#include <string>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// The fraction of the explainable residual energy (beyond noise and the model's floor, in units of these)
/// that falls into one part of the recording, with a 95% interval from a bootstrap over blocks of a second.
struct GapFraction {
    std::string by;    ///< run, channel, regime, direction, speed, tension, since reversal, session, place
    std::string name;  ///< of the part
    double fraction = 0.0;
    double low = 0.0;
    double high = 0.0;
    double of_samples = 0.0;  ///< fraction of the compared samples in this part, as an even gap would have
};

/// The residuals of the nominal model in one run.
struct RunResiduals {
    std::size_t run = 0;
    std::vector<std::vector<double>>
        residual;                          // channels x samples, in units of scale; empty if not compared
    std::vector<double> sliding_fraction;  // samples, of the nominal model
    int first_sample = 0;                  ///< before it lies the first loading from rest
};

/// One way to sort a recording's samples into named parts. A sample that belongs to no part, or lies before
/// the first that is compared, has the index -1.
struct SampleSorting {
    std::string by;
    std::vector<std::string> parts;
    std::vector<std::vector<int>> part_of;  // runs x samples
};

/// By regime, direction, speed, tension, time since reversal, and time in the session.
std::vector<SampleSorting> sample_sortings(const Recording& recording, const std::vector<RunResiduals>& runs);

/// Name of the part of the kind `place` that a sensor's readings make.
std::string place_part(const TensionSensor& sensor);

/// Empty if nothing is left beyond noise and floor.
std::vector<GapFraction> gap_map(const Recording& recording, const std::vector<RunResiduals>& runs);

/// One sentence for a reader: where the gap is concentrated.
std::string gap_sentence(const std::vector<GapFraction>& map);

}  // namespace capstan::gap
