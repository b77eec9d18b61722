#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

void fuse_weighted_mean(const FusionInput& input, std::span<double> tension_N) {
    average_profiles(input.unknown, input.vote->sensors(), input.weight, tension_N);
}

}  // namespace

const FusionMethod weighted_mean_method = {
    .name = "w_mean",
    .title = "W Mean",
    .knowledge = Knowledge::direction_unknown,
    .meaning = "average of the single-sensor estimates, each weighted by 1 / its sensor's mean error",
    .source = "paper Sec. II.C.2",
    .fuse = fuse_weighted_mean,
    .uses_weights = true,
    .averaging = Averaging{.weights = Averaging::Weights::by_error},
};

}  // namespace capstan
