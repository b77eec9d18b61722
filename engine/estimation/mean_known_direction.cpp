#include <algorithm>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

// A sensor at rest tells nothing; if all rest, each "estimate" is the previous state, and so is the mean.
void fuse(const FusionInput& input, std::span<double> tension_N) {
    std::fill(tension_N.begin(), tension_N.end(), 0.0);
    const bool any_moves = std::any_of(input.sensors.begin(), input.sensors.end(),
                                       [&](int sensor) { return input.known.verified[sensor] != 0; });
    int used = 0;
    for (const int sensor : input.sensors) {
        if (any_moves && !input.known.verified[sensor]) continue;
        const auto profile_N = input.known.profile_N(sensor);
        for (std::size_t node = 0; node < tension_N.size(); ++node) tension_N[node] += profile_N[node];
        ++used;
    }
    for (double& tension : tension_N) tension /= used;
}

}  // namespace

const FusionMethod mean_known_direction = {
    "mean_known",
    "Mean, direction known",
    Knowledge::direction_known,
    "average of the single-sensor estimates under the true direction of every segment",
    "paper Sec. II.C.1",
    fuse};

}  // namespace capstan
