#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

void fuse(const FusionInput& input, std::span<double> tension_N) {
    average_profiles(input.unknown, input.vote->sensors(), {}, tension_N);
}

}  // namespace

const FusionMethod mean_method = {"mean",
                                  "Mean",
                                  Knowledge::direction_unknown,
                                  "average of the single-sensor estimates",
                                  "paper Sec. II.C.2",
                                  fuse};

}  // namespace capstan
