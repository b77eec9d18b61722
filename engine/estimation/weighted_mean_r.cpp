#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

// The weights of excluded estimates are not shared out among the others: the sum is too small by their share.
// That is what the paper's numbers show (W Mean-R worse than W Mean), so it stays.
void fuse_weighted_mean_r(const FusionInput& input, std::span<double> tension_N) {
    if (input.vote->unanimous)
        return average_profiles(input.unknown, input.vote->sensors(), input.weight, tension_N);
    const EstimateSums sums = sum_estimates(input, input.weight);
    for (std::size_t node = 0; node < tension_N.size(); ++node) {
        const bool any_agrees = sums.agreeing_weight[node] > 0.0;
        tension_N[node] = (any_agrees ? sums.agreeing_N[node] : sums.all_N[node]) / sums.weight;
    }
}

}  // namespace

const FusionMethod weighted_mean_r_method = {
    .name = "w_mean_r",
    .title = "W Mean-R",
    .knowledge = Knowledge::direction_unknown,
    .meaning =
        "as W Mean, leaving out at each node the estimates that "
        "disagree with the median direction, without sharing "
        "out their weight",
    .source = "paper Sec. II.C.2",
    .fuse = fuse_weighted_mean_r,
    .uses_weights = true,
    .averaging = Averaging{.weights = Averaging::Weights::by_error,
                           .disagreeing = Averaging::Disagreeing::left_out_unshared},
};

}  // namespace capstan
