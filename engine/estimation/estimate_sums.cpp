#include "capstan/estimation/estimate_sums.h"

#include <algorithm>

namespace capstan {

namespace {

// 1.0 where bit i of the index is set: turns four agreement bits into factors.
constexpr double bit_factor[1 << profile_group][profile_group] = {
    {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 1, 0},
    {0, 1, 1, 0}, {1, 1, 1, 0}, {0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1},
    {0, 0, 1, 1}, {1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 1, 1}};

double weight_of(std::span<const double> weight, int sensor) {
    return weight.empty() ? 1.0 : weight[sensor];
}

}  // namespace

// Profiles are padded to whole groups of `profile_group` nodes, so that the inner loops have a fixed length
// and become vector instructions; no sum changes its order by that.

void average_profiles(const SensorEstimates& estimates, std::span<const int> sensors,
                      std::span<const double> weight, std::span<double> tension_N) {
    double total = 0.0;
    for (const int sensor : sensors) total += weight_of(weight, sensor);
    for (int first = 0; first < estimates.nodes; first += profile_group) {
        double sum_N[profile_group] = {};
        for (const int sensor : sensors) {
            const double* profile_N = estimates.padded_profile_N(sensor) + first;
            const double factor = weight_of(weight, sensor);
            for (int i = 0; i < profile_group; ++i) sum_N[i] += factor * profile_N[i];
        }
        const int here = std::min(profile_group, estimates.nodes - first);
        for (int i = 0; i < here; ++i) tension_N[first + i] = sum_N[i] / total;
    }
}

EstimateSums sum_estimates(const FusionInput& input, std::span<const double> weight) {
    const SensorVote& vote = *input.vote;
    EstimateSums sums;
    for (int k = 0; k < vote.used; ++k) sums.weight += weight_of(weight, vote.sensor[k]);
    for (int first = 0; first < input.unknown.nodes; first += profile_group) {
        double all_N[profile_group] = {};
        double agreeing_N[profile_group] = {};
        double agreeing_weight[profile_group] = {};
        for (int k = 0; k < vote.used; ++k) {
            const double* profile_N = input.unknown.padded_profile_N(vote.sensor[k]) + first;
            const double factor = weight_of(weight, vote.sensor[k]);
            const double* here = bit_factor[vote.agrees[k] >> first & ((1 << profile_group) - 1)];
            for (int i = 0; i < profile_group; ++i) {
                const double part_N = factor * profile_N[i];
                all_N[i] += part_N;
                agreeing_N[i] += here[i] * part_N;
                agreeing_weight[i] += here[i] * factor;
            }
        }
        std::copy_n(all_N, profile_group, sums.all_N.begin() + first);
        std::copy_n(agreeing_N, profile_group, sums.agreeing_N.begin() + first);
        std::copy_n(agreeing_weight, profile_group, sums.agreeing_weight.begin() + first);
    }
    return sums;
}

}  // namespace capstan
