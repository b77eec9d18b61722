// Runs for every sensor set in every repetition, so it uses whatever SIMD the processor has (Highway, chosen
// at run time). Four partial sums whatever the width and no fused multiply-add: the same bits everywhere.
#include "capstan/search/subset_sums.h"

#include "capstan/estimation/sensor_vote.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/search/subset_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, profile_group>;  // its lanes divide a group

void fill(const SensorSubsets& subsets, const double* const* profile_N, const double* truth_N,
          const double* fraction, SubsetSums& sums) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int stride = sums.stride;
    const bool keeps_averages = !sums.average_N.empty();
    for (int s = 1; s < subsets.count(); ++s) {
        const int place = subsets.last_place(s);
        const auto factor = hn::Set(d, sums.factor[place]);
        const auto weight = hn::Set(d, sums.weight[s]);
        const double* before =
            sums.tension_N.data() + static_cast<std::ptrdiff_t>(subsets.without_last(s)) * stride;
        const double* profile = profile_N[place];
        double* sum = sums.tension_N.data() + static_cast<std::ptrdiff_t>(s) * stride;
        double* average =
            keeps_averages ? sums.average_N.data() + static_cast<std::ptrdiff_t>(s) * stride : nullptr;
        double partial[profile_group];
        for (int first = 0; first < profile_group; first += lanes) {
            auto error = hn::Zero(d);
            for (int node = first; node < stride; node += profile_group) {
                const auto here =
                    hn::Add(hn::LoadU(d, before + node), hn::Mul(factor, hn::LoadU(d, profile + node)));
                const auto mean = hn::Div(here, weight);
                hn::StoreU(here, d, sum + node);
                if (keeps_averages) hn::StoreU(mean, d, average + node);
                const auto off = hn::Abs(hn::Sub(mean, hn::LoadU(d, truth_N + node)));
                error = hn::Add(error, hn::Mul(hn::LoadU(d, fraction + node), off));
            }
            hn::StoreU(error, d, partial + first);
        }
        sums.mean_abs_N[s] = (partial[0] + partial[1]) + (partial[2] + partial[3]);
    }
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(fill);

SubsetSums make_subset_sums(const SensorSubsets& subsets, std::vector<double> factor, int nodes,
                            Averages averages) {
    SubsetSums sums;
    sums.stride = padded_nodes(nodes);
    sums.factor = std::move(factor);
    sums.weight.assign(subsets.count(), 0.0);
    for (int s = 1; s < subsets.count(); ++s) {
        sums.weight[s] = sums.weight[subsets.without_last(s)] + sums.factor[subsets.last_place(s)];
    }
    // A group of four that begins at any node of the last set may be read.
    sums.tension_N.assign(static_cast<std::size_t>(subsets.count()) * sums.stride + profile_group, 0.0);
    if (averages == Averages::keep) sums.average_N = sums.tension_N;
    sums.mean_abs_N.assign(subsets.count(), 0.0);
    return sums;
}

void fill_subset_sums(const SensorSubsets& subsets, std::span<const double* const> profile_N,
                      std::span<const double> truth_N, std::span<const double> fraction, SubsetSums& sums) {
    HWY_DYNAMIC_DISPATCH(fill)(subsets, profile_N.data(), truth_N.data(), fraction.data(), sums);
}

}  // namespace capstan
#endif
