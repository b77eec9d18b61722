// Where a study with the paper's methods spends its time, so it runs on whatever SIMD the processor has
// (Highway, chosen at run time). Profiles are padded to complete groups of nodes; each node's sum keeps its
// order and there is no fused multiply-add, so every processor gives the same bits.
#include "capstan/estimation/estimate_sums.h"

#include <algorithm>

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/estimation/estimate_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, profile_group>;  // its lanes divide a group

// Weighted sums of profiles, `stride` apart: result[node] = sum of factor[k] * profile of sensor[k].
void sum_profiles(const double* HWY_RESTRICT profiles_N, int stride, const int* sensor, const double* factor,
                  int count, double* HWY_RESTRICT sum_N) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int node = 0; node < stride; node += lanes) {
        auto sum = hn::Zero(d);
        for (int k = 0; k < count; ++k) {
            const auto profile =
                hn::LoadU(d, profiles_N + static_cast<std::ptrdiff_t>(sensor[k]) * stride + node);
            sum = hn::Add(sum, hn::Mul(hn::Set(d, factor[k]), profile));
        }
        hn::StoreU(sum, d, sum_N + node);
    }
}

// The same, and beside it the sums over those that agree at the node; `here` is 1 or 0 for each (k, node).
void sum_agreeing(const double* HWY_RESTRICT profiles_N, int stride, const int* sensor, const double* factor,
                  const double* const* here, int count, EstimateSums& sums) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int node = 0; node < stride; node += lanes) {
        auto all = hn::Zero(d);
        auto agreeing = hn::Zero(d);
        auto weight = hn::Zero(d);
        const int group = node / profile_group;
        for (int k = 0; k < count; ++k) {
            const auto f = hn::Set(d, factor[k]);
            const auto part =
                hn::Mul(f, hn::LoadU(d, profiles_N + static_cast<std::ptrdiff_t>(sensor[k]) * stride + node));
            const auto agrees = hn::LoadU(d, here[group * count + k] + node % profile_group);
            all = hn::Add(all, part);
            agreeing = hn::Add(agreeing, hn::Mul(agrees, part));
            weight = hn::Add(weight, hn::Mul(agrees, f));
        }
        hn::StoreU(all, d, sums.all_N.data() + node);
        hn::StoreU(agreeing, d, sums.agreeing_N.data() + node);
        hn::StoreU(weight, d, sums.agreeing_weight.data() + node);
    }
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(sum_profiles);
HWY_EXPORT(sum_agreeing);

namespace {

// 1.0 where bit i of the index is set: turns four agreement bits into factors.
constexpr double bit_factor[1 << profile_group][profile_group] = {
    {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 1, 0},
    {0, 1, 1, 0}, {1, 1, 1, 0}, {0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1},
    {0, 0, 1, 1}, {1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 1, 1}};

constexpr int max_groups = max_estimated_nodes / profile_group;

using Factors = std::array<double, max_estimated_nodes>;

// The weight of each used sensor, and their sum.
double gather(std::span<const int> sensors, std::span<const double> weight, Factors& factor) {
    double total = 0.0;
    for (std::size_t k = 0; k < sensors.size(); ++k) {
        factor[k] = weight.empty() ? 1.0 : weight[sensors[k]];
        total += factor[k];
    }
    return total;
}

}  // namespace

void average_profiles(const SensorEstimates& estimates, std::span<const int> sensors,
                      std::span<const double> weight, std::span<double> tension_N) {
    Factors factor;
    const double total = gather(sensors, weight, factor);
    std::array<double, max_estimated_nodes> sum_N;
    HWY_DYNAMIC_DISPATCH(sum_profiles)
    (estimates.tension_N.data(), padded_nodes(estimates.nodes), sensors.data(), factor.data(),
     static_cast<int>(sensors.size()), sum_N.data());
    for (int node = 0; node < estimates.nodes; ++node) tension_N[node] = sum_N[node] / total;
}

EstimateSums sum_estimates(const FusionInput& input, std::span<const double> weight) {
    const SensorVote& vote = *input.vote;
    const int stride = padded_nodes(input.unknown.nodes);
    EstimateSums sums;
    Factors factor;
    sums.weight = gather(vote.sensors(), weight, factor);
    std::array<const double*, max_groups * max_estimated_nodes> here;  // groups x used
    for (int group = 0; group < stride / profile_group; ++group) {
        for (int k = 0; k < vote.used; ++k) {
            const std::uint64_t bits = vote.agrees[k] >> (group * profile_group);
            here[group * vote.used + k] = bit_factor[bits & ((1 << profile_group) - 1)];
        }
    }
    HWY_DYNAMIC_DISPATCH(sum_agreeing)
    (input.unknown.tension_N.data(), stride, vote.sensor.data(), factor.data(), here.data(), vote.used, sums);
    return sums;
}

}  // namespace capstan
#endif
