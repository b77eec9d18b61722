#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

// The weights of excluded estimates are not shared out among the others: the sum is too small by their share.
// That is what the paper's numbers show (W Mean-R worse than W Mean), so it stays.
void fuse(const FusionInput& input, std::span<double> tension_N) {
    const SensorVote& vote = *input.vote;
    double total = 0.0;
    for (int k = 0; k < vote.used; ++k) total += input.weight[vote.sensor[k]];
    for (std::size_t node = 0; node < tension_N.size(); ++node) {
        double all_N = 0.0;
        double agreeing_N = 0.0;
        bool any_agrees = false;
        for (int k = 0; k < vote.used; ++k) {
            const int sensor = vote.sensor[k];
            const double part_N = input.weight[sensor] * input.unknown.profile_N(sensor)[node];
            all_N += part_N;
            if (vote.agrees[k] >> node & 1) {
                agreeing_N += part_N;
                any_agrees = true;
            }
        }
        tension_N[node] = (any_agrees ? agreeing_N : all_N) / total;
    }
}

}  // namespace

const FusionMethod weighted_mean_r_method = {"w_mean_r",
                                             "W Mean-R",
                                             Knowledge::direction_unknown,
                                             "as W Mean, leaving out at each node the estimates that "
                                             "disagree with the median direction, without sharing "
                                             "out their weight",
                                             "paper Sec. II.C.2",
                                             fuse};

}  // namespace capstan
