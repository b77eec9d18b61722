#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

void fuse(const FusionInput& input, std::span<double> tension_N) {
    average_profiles(input.unknown, input.vote->sensors(), input.weight, tension_N);
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
