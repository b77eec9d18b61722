#include "capstan/recording/driven_inputs.h"

#include <algorithm>
#include <cmath>

#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"
#include "capstan/sensing/random_stream.h"

namespace capstan {

namespace {

// A tenth of a second at 200 Hz: a hand's motion is close to a parabola for at most this long.
constexpr int widest_half_window = 20;
constexpr int parabola_numbers = 3;

// What the residual of a parabola that explains the samples is at most, in units of their noise, in 96 of 100
// cases: the quantile of chi-square over its degrees of freedom (Wilson and Hilferty 1931).
double largest_by_chance(int half) {
    constexpr double quantile = 1.75;
    const double spread = 2.0 / (9.0 * (2 * half + 1 - parabola_numbers));
    return std::pow(1.0 - spread + quantile * std::sqrt(spread), 1.5);
}

struct LocalParabola {
    double at_centre = 0.0;
    double residual_std = 0.0;
};

LocalParabola parabola_around(const std::vector<double>& samples, int centre, int half) {
    const double* middle = samples.data() + centre;
    double squares = 0.0;  // of the offsets
    double fourths = 0.0;
    double sum = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (int offset = -half; offset <= half; ++offset) {
        const double square = static_cast<double>(offset) * offset;
        squares += square;
        fourths += square * square;
        sum += middle[offset];
        first += offset * middle[offset];
        second += square * middle[offset];
    }
    const double count = 2 * half + 1;
    const double determinant = count * fourths - squares * squares;
    const double constant = (sum * fourths - second * squares) / determinant;
    const double linear = first / squares;
    const double quadratic = (count * second - squares * sum) / determinant;
    double misfit = 0.0;
    for (int offset = -half; offset <= half; ++offset) {
        const double error = middle[offset] - (constant + offset * (linear + offset * quadratic));
        misfit += error * error;
    }
    return {constant, std::sqrt(misfit / (count - parabola_numbers))};
}

}  // namespace

std::vector<double> smoothed(const std::vector<double>& samples, double noise_std) {
    if (noise_std <= 0.0) return samples;
    std::vector<double> smooth = samples;
    const int count = static_cast<int>(samples.size());
    for (int centre = 0; centre < count; ++centre) {
        int half = std::min({widest_half_window, centre, count - 1 - centre});
        for (; half >= 2; half = 2 * half / 3) {
            const LocalParabola parabola = parabola_around(samples, centre, half);
            if (parabola.residual_std <= largest_by_chance(half) * noise_std) {
                smooth[static_cast<std::size_t>(centre)] = parabola.at_centre;
                break;
            }
        }
    }
    return smooth;
}

double sample_noise(const Channel& channel) {
    const double noise = channel.noise_std.value_or(0.0);
    const double step = channel.step.value_or(0.0);
    return std::sqrt(noise * noise + step * step / 12.0);
}

DrivenInputs driven_inputs(const Recording& recording, const RecordedRun& run) {
    DrivenInputs inputs;
    inputs.values.resize(recording.channels.size());
    for (std::size_t index = 0; index < recording.channels.size(); ++index) {
        const Channel& channel = recording.channels[index];
        if (!run.drives(channel.name)) continue;
        const std::vector<double>& samples = run.values[index];
        const bool held = channel.name == channel::load_angle && run.output == OutputKind::locked;
        inputs.values[index] = held ? std::vector<double>(samples.size(), upper_median(samples))
                                    : smoothed(samples, sample_noise(channel));
    }
    return inputs;
}

DrivenInputs driven_inputs_again(const Recording& recording, const RecordedRun& run, int measurement) {
    DrivenInputs inputs = driven_inputs(recording, run);
    for (std::size_t index = 0; index < recording.channels.size(); ++index) {
        std::vector<double>& samples = inputs.values[index];
        const double noise = sample_noise(recording.channels[index]);
        const bool held =
            recording.channels[index].name == channel::load_angle && run.output == OutputKind::locked;
        if (noise <= 0.0 || held) continue;
        for (std::size_t sample = 0; sample < samples.size(); ++sample)
            samples[sample] += noise * standard_normals({.seed = static_cast<std::uint64_t>(measurement),
                                                         .purpose = RandomPurpose::driven_reading,
                                                         .scenario = static_cast<std::uint32_t>(sample),
                                                         .repetition = static_cast<std::uint32_t>(run.number),

                                                         .node = static_cast<std::uint32_t>(index)})[0];
        samples = smoothed(samples, noise);
    }
    return inputs;
}

}  // namespace capstan
