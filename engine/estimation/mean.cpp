#include <algorithm>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

void fuse(const FusionInput& input, std::span<double> tension_N) {
    std::fill(tension_N.begin(), tension_N.end(), 0.0);
    for (int k = 0; k < input.vote->used; ++k) {
        const auto profile_N = input.unknown.profile_N(input.vote->sensor[k]);
        for (std::size_t node = 0; node < tension_N.size(); ++node) tension_N[node] += profile_N[node];
    }
    for (double& tension : tension_N) tension /= input.vote->used;
}

}  // namespace

const FusionMethod mean_method = {"mean",
                                  "Mean",
                                  Knowledge::direction_unknown,
                                  "average of the single-sensor estimates",
                                  "paper Sec. II.C.2",
                                  fuse};

}  // namespace capstan
