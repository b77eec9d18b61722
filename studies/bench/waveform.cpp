#include "capstan/bench/waveform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace capstan::bench {

namespace {

double sum_of_sines(const Waveform& wave, double time_s) {
    double sum = 0.0;
    for (std::size_t k = 0; k < wave.amplitudes.size(); ++k) {
        const double phase_rad = 2.0 * std::numbers::pi * wave.frequency_Hz[k] * time_s + wave.phase_rad[k];
        sum += wave.amplitudes[k] * std::sin(phase_rad);
    }
    return sum;
}

double ramp(const Waveform& wave, double time_s) {
    const double quarter_s = wave.ramp_amplitude / wave.slope_per_s;
    if (time_s < quarter_s) return wave.slope_per_s * time_s;
    const double half_period_s = wave.dwell_s + 2.0 * quarter_s;
    const double since_top_s = time_s - quarter_s;
    const double half_periods = std::floor(since_top_s / half_period_s);
    const double into_s = since_top_s - half_periods * half_period_s;
    const double side = std::fmod(half_periods, 2.0) == 0.0 ? 1.0 : -1.0;
    const double fallen = wave.slope_per_s * std::max(into_s - wave.dwell_s, 0.0);
    return side * (wave.ramp_amplitude - fallen);
}

double step(const Waveform& wave, double time_s) {
    // A time of k holds that was rounded down still belongs to the k-th step.
    constexpr double rounding = 1e-9;
    const auto steps = static_cast<std::size_t>(std::floor(time_s / wave.hold_s + rounding));
    return wave.levels[steps % wave.levels.size()];
}

}  // namespace

double Waveform::at(double time_s) const {
    switch (kind) {
        case WaveformKind::constant:
            return level;
        case WaveformKind::sines:
            return sum_of_sines(*this, time_s);
        case WaveformKind::ramps:
            return ramp(*this, time_s);
        case WaveformKind::steps:
            return step(*this, time_s);
    }
    return 0.0;
}

}  // namespace capstan::bench
