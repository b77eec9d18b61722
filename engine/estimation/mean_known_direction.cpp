#include <array>

#include "capstan/estimation/estimate_sums.h"

namespace capstan {

namespace {

// A sensor at rest tells nothing; if all rest, each "estimate" is the previous state, and so is the mean.
void fuse_known_direction(const FusionInput& input, std::span<double> tension_N) {
    std::array<int, max_estimated_nodes> moving;
    std::size_t count = 0;
    for (const int sensor : input.sensors) {
        if (input.known.verified[sensor]) moving[count++] = sensor;
    }
    const std::span<const int> used = count > 0 ? std::span<const int>(moving).first(count) : input.sensors;
    average_profiles(input.known, used, {}, tension_N);
}

}  // namespace

const FusionMethod mean_known_direction = {
    .name = "mean_known",
    .title = "Mean, direction known",
    .knowledge = Knowledge::direction_known,
    .meaning = "average of the single-sensor estimates under the true direction of every segment",
    .source = "paper Sec. II.C.1",
    .fuse = fuse_known_direction,
};

}  // namespace capstan
