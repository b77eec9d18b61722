#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

void fuse_maximum_likelihood(const FusionInput& input, std::span<double> tension_N) {
    maximum_likelihood(*input.curve, input.log_likelihood, tension_N);
}

}  // namespace

const FusionMethod maximum_likelihood_method = {
    .name = "maximum_likelihood",
    .title = "Maximum likelihood",
    .knowledge = Knowledge::feasible_curve,
    .meaning = "the feasible state under which the readings are most likely",
    .source = "capstan (E10, E11)",
    .fuse = fuse_maximum_likelihood,
};

}  // namespace capstan
