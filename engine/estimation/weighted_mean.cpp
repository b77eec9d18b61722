#include <algorithm>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

void fuse(const FusionInput& input, std::span<double> tension_N) {
    std::fill(tension_N.begin(), tension_N.end(), 0.0);
    double total = 0.0;
    for (int k = 0; k < input.vote->used; ++k) {
        const int sensor = input.vote->sensor[k];
        const double weight = input.weight[sensor];
        const auto profile_N = input.unknown.profile_N(sensor);
        for (std::size_t node = 0; node < tension_N.size(); ++node)
            tension_N[node] += weight * profile_N[node];
        total += weight;
    }
    for (double& tension : tension_N) tension /= total;
}

}  // namespace

const FusionMethod weighted_mean_method = {
    "w_mean",
    "W Mean",
    Knowledge::direction_unknown,
    "average of the single-sensor estimates, each weighted by 1 / its sensor's mean error",
    "paper Sec. II.C.2",
    fuse};

}  // namespace capstan
