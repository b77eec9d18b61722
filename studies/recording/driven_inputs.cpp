#include "capstan/recording/driven_inputs.h"

#include <algorithm>
#include <cmath>

#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan {

namespace {

// A tenth of a second at 200 Hz: a hand's motion is close to a parabola for at most this long.
constexpr int widest_half_window = 20;
// A parabola explains the samples if its residual is at most this many times the noise.
constexpr double explained = 1.2;
constexpr int parabola_numbers = 3;

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
            if (parabola.residual_std <= explained * noise_std) {
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

}  // namespace capstan
