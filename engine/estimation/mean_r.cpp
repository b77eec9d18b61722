#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

// Where no estimate agrees with the consensus the plain mean stands in (the paper does not say).
void fuse(const FusionInput& input, std::span<double> tension_N) {
    const SensorVote& vote = *input.vote;
    for (std::size_t node = 0; node < tension_N.size(); ++node) {
        double all_N = 0.0;
        double agreeing_N = 0.0;
        int agreeing = 0;
        for (int k = 0; k < vote.used; ++k) {
            const double estimate_N = input.unknown.profile_N(vote.sensor[k])[node];
            all_N += estimate_N;
            if (vote.agrees[k] >> node & 1) {
                agreeing_N += estimate_N;
                ++agreeing;
            }
        }
        tension_N[node] = agreeing > 0 ? agreeing_N / agreeing : all_N / vote.used;
    }
}

}  // namespace

const FusionMethod mean_r_method = {
    "mean_r",
    "Mean-R",
    Knowledge::direction_unknown,
    "average, at each node, of the estimates that agree there with the median direction",
    "paper Sec. II.C.2",
    fuse};

}  // namespace capstan
