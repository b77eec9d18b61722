
#include <cmath>
#include <utility>

#include "capstan/platform/statistics.h"
#include "capstan/recording/driven_inputs.h"

namespace capstan {

namespace {

// For white noise the second difference of samples has 6 times their variance, and the median of absolute
// values is 0.6745 standard deviations.
double noise_of(const Recording& recording, std::size_t channel) {
    std::vector<double> sizes;
    for (const RecordedRun& run : recording.runs) {
        const std::vector<double>& values = run.values[channel];
        for (std::size_t sample = 1; sample + 1 < values.size(); ++sample)
            sizes.push_back(std::abs(values[sample - 1] - 2.0 * values[sample] + values[sample + 1]));
    }
    if (sizes.empty()) return 0.0;
    return upper_median(std::move(sizes)) / (0.6745 * std::sqrt(6.0));
}

}  // namespace

Recording with_estimated_noise(Recording recording) {
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        Channel& described = recording.channels[channel];
        if (described.noise_std) continue;
        // The second differences of a rounded channel are steps, which its stated step already explains.
        const double found = noise_of(recording, channel);
        described.noise_std = found > described.step.value_or(0.0) ? found : 0.0;
    }
    return recording;
}

}  // namespace capstan
