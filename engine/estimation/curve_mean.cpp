// The posterior mean is where a study spends its time, so it runs on whatever SIMD the processor has
// (Highway, chosen at run time). Each instruction set gives the same bits every time; two of them may differ
// in the last.
#include "capstan/estimation/feasible_curve.h"

// foreach_target.h comes before highway.h, and the maths after both.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/estimation/curve_mean.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;  // points are a multiple of 8

// Turns log likelihoods into weights exp(l - max l); returns their sum.
double exponentiate(double* HWY_RESTRICT log_likelihood, int points) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    auto largest = hn::LoadU(d, log_likelihood);
    for (int k = lanes; k < points; k += lanes) largest = hn::Max(largest, hn::LoadU(d, log_likelihood + k));
    const auto top = hn::MaxOfLanes(d, largest);
    auto sum = hn::Zero(d);
    for (int k = 0; k < points; k += lanes) {
        const auto weight = hn::Exp(d, hn::Sub(hn::LoadU(d, log_likelihood + k), top));
        hn::StoreU(weight, d, log_likelihood + k);
        sum = hn::Add(sum, weight);
    }
    return hn::GetLane(hn::SumOfLanes(d, sum));
}

// Four nodes at a time: the weights are loaded once for all four.
void weighted_sums(const double* HWY_RESTRICT weight, const double* HWY_RESTRICT tension_N, int points,
                   int nodes, double* HWY_RESTRICT result) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int node = 0;
    for (; node + 4 <= nodes; node += 4) {
        const double* row = tension_N + static_cast<std::size_t>(node) * points;
        auto a = hn::Zero(d);
        auto b = hn::Zero(d);
        auto c = hn::Zero(d);
        auto e = hn::Zero(d);
        for (int k = 0; k < points; k += lanes) {
            const auto w = hn::LoadU(d, weight + k);
            a = hn::MulAdd(w, hn::LoadU(d, row + k), a);
            b = hn::MulAdd(w, hn::LoadU(d, row + points + k), b);
            c = hn::MulAdd(w, hn::LoadU(d, row + 2 * points + k), c);
            e = hn::MulAdd(w, hn::LoadU(d, row + 3 * points + k), e);
        }
        result[node] = hn::GetLane(hn::SumOfLanes(d, a));
        result[node + 1] = hn::GetLane(hn::SumOfLanes(d, b));
        result[node + 2] = hn::GetLane(hn::SumOfLanes(d, c));
        result[node + 3] = hn::GetLane(hn::SumOfLanes(d, e));
    }
    for (; node < nodes; ++node) {
        const double* row = tension_N + static_cast<std::size_t>(node) * points;
        auto a = hn::Zero(d);
        for (int k = 0; k < points; k += lanes) {
            a = hn::MulAdd(hn::LoadU(d, weight + k), hn::LoadU(d, row + k), a);
        }
        result[node] = hn::GetLane(hn::SumOfLanes(d, a));
    }
}

void mean_of_curve(double* HWY_RESTRICT log_likelihood, const double* HWY_RESTRICT tension_N, int points,
                   int nodes, double* HWY_RESTRICT result) {
    const double total = exponentiate(log_likelihood, points);
    weighted_sums(log_likelihood, tension_N, points, nodes, result);
    for (int node = 0; node < nodes; ++node) result[node] /= total;
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(mean_of_curve);

void posterior_mean(const FeasibleCurve& curve, std::span<double> log_likelihood,
                    std::span<double> tension_N) {
    HWY_DYNAMIC_DISPATCH(mean_of_curve)
    (log_likelihood.data(), curve.tension_N(0).data(), curve.points(), curve.nodes(), tension_N.data());
}

}  // namespace capstan
#endif
