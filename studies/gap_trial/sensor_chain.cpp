#include "capstan/gap_trial/sensor_chain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

constexpr double cutoff_Hz = 40.0;

void butterworth(std::vector<double>& signal, double corner_Hz, double rate_Hz) {
    // Bilinear transform, prewarped.
    const double k = std::tan(std::numbers::pi * corner_Hz / rate_Hz);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
    const double b0 = k * k * norm;
    const double a1 = 2.0 * (k * k - 1.0) * norm;
    const double a2 = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
    // At rest at the first sample.
    double x1 = signal.front(), x2 = x1, y1 = x1, y2 = x1;
    for (double& value : signal) {
        const double y = b0 * (value + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
        x2 = x1;
        x1 = value;
        y2 = y1;
        y1 = y;
        value = y;
    }
}

void apply_play(std::vector<double>& signal, double half_width) {
    double reading = signal.front();
    for (double& value : signal) {
        reading = std::clamp(reading, value - half_width, value + half_width);
        value = reading;
    }
}

void apply_hysteresis(std::vector<double>& signal, double half_width, double spread) {
    if (spread == 0.0) {
        apply_play(signal, half_width);
        return;
    }
    std::vector<double> wide = signal;
    apply_play(signal, (1.0 - spread) * half_width);
    apply_play(wide, (1.0 + spread) * half_width);
    for (std::size_t k = 0; k < signal.size(); ++k) signal[k] = 0.5 * (signal[k] + wide[k]);
}

void apply_lag(std::vector<double>& signal, double lag_s) {
    const double fraction = -std::expm1(-1.0 / (fine_rate_Hz * lag_s));
    double reading = signal.front();
    for (double& value : signal) {
        reading += fraction * (value - reading);
        value = reading;
    }
}

void apply_delay(std::vector<double>& signal, double delay_s) {
    const std::vector<double> original = signal;
    const double last = static_cast<double>(signal.size() - 1);
    for (std::size_t k = 0; k < signal.size(); ++k) {
        const double place = std::clamp(static_cast<double>(k) - delay_s * fine_rate_Hz, 0.0, last);
        const auto below = std::min(static_cast<std::size_t>(place), signal.size() - 2);
        const double fraction = place - static_cast<double>(below);
        signal[k] = (1.0 - fraction) * original[below] + fraction * original[below + 1];
    }
}

// The signs and the zero with which a drive's laboratory mounted its load sensors.
void mount(const TrialBench& bench, const std::string& channel, std::vector<double>& signal) {
    if (!bench.is_drive()) return;
    const bool is_angle = channel == channel::load_angle;
    if (!is_angle && channel != channel::load_torque) return;
    const double sign = is_angle ? bench.load_angle_sign : bench.load_torque_sign;
    const double zero = is_angle ? bench.load_angle_zero_rad : 0.0;
    for (double& value : signal) value = zero + sign * value;
}

void apply(const TrueSensorFault& fault, std::vector<double>& signal) {
    if (fault.hysteresis > 0.0) apply_hysteresis(signal, fault.hysteresis, fault.hysteresis_spread);
    if (fault.lag_s > 0.0 && fault.lag_in_two_stages) {
        apply_lag(signal, 0.5 * fault.lag_s);
        apply_lag(signal, 0.5 * fault.lag_s);
    } else if (fault.lag_s > 0.0) {
        apply_lag(signal, fault.lag_s);
    }
    if (fault.delay_s != 0.0) apply_delay(signal, fault.delay_s);
    for (std::size_t k = 0; k < signal.size(); ++k) {
        double& value = signal[k];
        value = fault.gain * value + fault.offset;
        if (fault.hum != 0.0)
            value += fault.hum *
                     std::sin(2.0 * std::numbers::pi * fault.hum_Hz * static_cast<double>(k) / fine_rate_Hz);
        if (fault.clipped_above > 0.0) value = std::clamp(value, -fault.clipped_above, fault.clipped_above);
    }
}

double rounded(double value, double step) {
    return step > 0.0 ? step * std::round(value / step) : value;
}

}  // namespace

void zero_phase_low_pass(std::vector<double>& signal, double corner_Hz, double rate_Hz) {
    butterworth(signal, corner_Hz, rate_Hz);
    std::reverse(signal.begin(), signal.end());
    butterworth(signal, corner_Hz, rate_Hz);
    std::reverse(signal.begin(), signal.end());
}

SensedRun sense(const TrialBench& bench, const TrueRun& run,
                const std::map<std::string, TrueSensorFault>& faults) {
    const std::vector<std::string> channels = bench.channels();
    SensedRun sensed(channels.size());
    const int stride = fine_rate_Hz / bench.logged_rate_Hz;
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        std::vector<double> signal = run.values[channel];
        mount(bench, channels[channel], signal);
        const auto fault = faults.find(channels[channel]);
        if (fault != faults.end()) apply(fault->second, signal);
        if (!channels[channel].ends_with("_angle")) zero_phase_low_pass(signal, cutoff_Hz, fine_rate_Hz);
        for (std::size_t k = 0; k < signal.size(); k += static_cast<std::size_t>(stride))
            sensed[channel].push_back(signal[k]);
    }
    return sensed;
}

SensedRun with_noise(const TrialBench& bench, const SensedRun& run,
                     const std::map<std::string, TrueSensorFault>& faults, TrialStream& draws) {
    const std::vector<std::string> channels = bench.channels();
    SensedRun logged = run;
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        const auto noise = bench.noise_std.find(channels[channel]);
        const auto step = bench.encoder_step.find(channels[channel]);
        const auto fault = faults.find(channels[channel]);
        for (double& value : logged[channel]) {
            if (noise != bench.noise_std.end()) value += noise->second * draws.normal();
            if (step != bench.encoder_step.end()) value = rounded(value, step->second);
            if (fault != faults.end()) value = rounded(value, fault->second.step);
        }
    }
    return logged;
}

}  // namespace capstan::gap_trial
