#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

void fuse_posterior_mean(const FusionInput& input, std::span<double> tension_N) {
    posterior_mean(*input.curve, input.log_likelihood, tension_N);
}

}  // namespace

const FusionMethod posterior_mean_method = {
    .name = "posterior_mean",
    .title = "Posterior mean",
    .knowledge = Knowledge::feasible_curve,
    .meaning = "the mean of all feasible states, each weighted by how likely it makes the readings",
    .source = "capstan (E10-E12)",
    .fuse = fuse_posterior_mean,
};

}  // namespace capstan
