#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

// Where no estimate agrees with the consensus the plain mean stands in (the paper does not say).
void fuse_mean_r(const FusionInput& input, std::span<double> tension_N) {
    if (input.vote->unanimous) return average_profiles(input.unknown, input.vote->sensors(), {}, tension_N);
    const EstimateSums sums = sum_estimates(input, {});
    for (std::size_t node = 0; node < tension_N.size(); ++node) {
        const bool any_agrees = sums.agreeing_weight[node] > 0.0;
        tension_N[node] =
            any_agrees ? sums.agreeing_N[node] / sums.agreeing_weight[node] : sums.all_N[node] / sums.weight;
    }
}

}  // namespace

const FusionMethod mean_r_method = {
    .name = "mean_r",
    .title = "Mean-R",
    .knowledge = Knowledge::direction_unknown,
    .meaning = "average, at each node, of the estimates that agree there with the median direction",
    .source = "paper Sec. II.C.2",
    .fuse = fuse_mean_r,
    .averaging = Averaging{.disagreeing = Averaging::Disagreeing::left_out},
};

}  // namespace capstan
