#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

void fuse_mean(const FusionInput& input, std::span<double> tension_N) {
    average_profiles(input.unknown, input.vote->sensors(), {}, tension_N);
}

}  // namespace

const FusionMethod mean_method = {
    .name = "mean",
    .title = "Mean",
    .knowledge = Knowledge::direction_unknown,
    .meaning = "average of the single-sensor estimates",
    .source = "paper Sec. II.C.2",
    .fuse = fuse_mean,
    .averaging = Averaging{},
};

}  // namespace capstan
