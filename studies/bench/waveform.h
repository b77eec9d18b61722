#pragma once

#include <vector>

namespace capstan::bench {

enum class WaveformKind {
    constant,
    sines,  ///< a sum of sines
    ramps,  ///< between +- an amplitude from zero, with a dwell at each end
    steps,  ///< one level after the other, repeated
};

/// An input over time. The input determines the unit of its values, N m or rad.
struct Waveform {
    WaveformKind kind = WaveformKind::constant;
    double level = 0.0;                ///< constant
    std::vector<double> amplitudes;    ///< sines
    std::vector<double> frequency_Hz;  ///< sines, one for each amplitude
    std::vector<double> phase_rad;     ///< sines, one for each amplitude
    double ramp_amplitude = 0.0;       ///< ramps
    double slope_per_s = 0.0;          ///< ramps
    double dwell_s = 0.0;              ///< ramps
    std::vector<double> levels;        ///< steps
    double hold_s = 0.0;               ///< steps: duration of each level

    double at(double time_s) const;
};

}  // namespace capstan::bench
