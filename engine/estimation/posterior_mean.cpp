#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

void fuse(const FusionInput& input, std::span<double> tension_N) {
    posterior_mean(*input.curve, input.log_likelihood, tension_N);
}

}  // namespace

const FusionMethod posterior_mean_method = {
    "posterior_mean",
    "Posterior mean",
    Knowledge::feasible_curve,
    "the mean of all feasible states, each weighted by how likely it makes the readings",
    "capstan (E10-E12)",
    fuse};

}  // namespace capstan
