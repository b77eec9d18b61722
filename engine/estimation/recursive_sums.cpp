#include "capstan/estimation/recursive_sums.h"

#include <algorithm>
#include <cmath>

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/estimation/recursive_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::ScalableTag<double>;
using One = hn::CappedTag<double, 1>;

// body(tag, node) on as many nodes at a time as fit, then on those left over one by one.
template <class Body>
void for_each_node(int nodes, const Body& body) {
    const Wide wide;
    const int lanes = static_cast<int>(hn::Lanes(wide));
    int node = 0;
    for (; node + lanes <= nodes; node += lanes) body(wide, node);
    for (; node < nodes; ++node) body(One(), node);
}

// Where four vectors of nodes begin.
struct FourPlaces {
    int a, b, c, d;
};

// The same with four(places) for four vectors at a time, so that one sum need not wait for the other. The
// last ones overlap those before: what is done twice gives the same numbers.
template <class FourTimes, class Body>
void for_each_node_by_four(int nodes, const FourTimes& four, const Body& body) {
    const int lanes = static_cast<int>(hn::Lanes(Wide()));
    if (nodes < lanes) return for_each_node(nodes, body);
    const auto place = [&](int node) { return std::min(node, nodes - lanes); };
    for (int node = 0; node < nodes; node += 4 * lanes)
        four(FourPlaces{place(node), place(node + lanes), place(node + 2 * lanes), place(node + 3 * lanes)});
}

template <class V>
struct Four {
    V a, b, c, d;
};

// The sum over members of term(member, tension there).
template <class D, class Term>
auto sum_over(D d, const double* const* tension_N, int members, int node, const Term& term) {
    auto sum = hn::Zero(d);
    for (int j = 0; j < members; ++j) sum = hn::Add(sum, term(j, hn::LoadU(d, tension_N[j] + node)));
    return sum;
}

template <class Term>
auto four_sums_over(const double* const* tension_N, int members, FourPlaces at, const Term& term) {
    const Wide d;
    auto a = hn::Zero(d), b = hn::Zero(d), c = hn::Zero(d), e = hn::Zero(d);
    for (int j = 0; j < members; ++j) {
        const double* row = tension_N[j];
        a = hn::Add(a, term(j, hn::LoadU(d, row + at.a), 0));
        b = hn::Add(b, term(j, hn::LoadU(d, row + at.b), 1));
        c = hn::Add(c, term(j, hn::LoadU(d, row + at.c), 2));
        e = hn::Add(e, term(j, hn::LoadU(d, row + at.d), 3));
    }
    return Four<decltype(a)>{a, b, c, e};
}

void moments(const double* const* tension_N, int members, int nodes, double* HWY_RESTRICT mean_N,
             double* HWY_RESTRICT deviation_N) {
    const auto finish = [&](auto d, auto squares, int node) {
        hn::StoreU(hn::Sqrt(hn::Div(squares, hn::Set(d, members - 1.0))), d, deviation_N + node);
    };
    const auto square = [](auto tension, auto mean) {
        const auto off = hn::Sub(tension, mean);
        return hn::Mul(off, off);
    };
    for_each_node_by_four(
        nodes,
        [&](FourPlaces at) {
            const Wide d;
            const auto count = hn::Set(d, static_cast<double>(members));
            const auto sum = four_sums_over(tension_N, members, at, [](int, auto t, int) { return t; });
            const auto a = hn::Div(sum.a, count), b = hn::Div(sum.b, count);
            const auto c = hn::Div(sum.c, count), e = hn::Div(sum.d, count);
            hn::StoreU(a, d, mean_N + at.a);
            hn::StoreU(b, d, mean_N + at.b);
            hn::StoreU(c, d, mean_N + at.c);
            hn::StoreU(e, d, mean_N + at.d);
            const auto squares = four_sums_over(tension_N, members, at, [&](int, auto t, int which) {
                return square(t, which == 0 ? a : which == 1 ? b : which == 2 ? c : e);
            });
            finish(d, squares.a, at.a);
            finish(d, squares.b, at.b);
            finish(d, squares.c, at.c);
            finish(d, squares.d, at.d);
        },
        [&](auto d, int node) {
            const auto sum = sum_over(d, tension_N, members, node, [](int, auto t) { return t; });
            const auto mean = hn::Div(sum, hn::Set(d, static_cast<double>(members)));
            hn::StoreU(mean, d, mean_N + node);
            finish(d, sum_over(d, tension_N, members, node, [&](int, auto t) { return square(t, mean); }),
                   node);
        });
}

void weighted_sums(const double* const* tension_N, const double* HWY_RESTRICT weight, int members, int nodes,
                   double* HWY_RESTRICT sum) {
    for_each_node_by_four(
        nodes,
        [&](FourPlaces at) {
            const Wide d;
            const auto here = four_sums_over(tension_N, members, at, [&](int j, auto t, int) {
                return hn::Mul(hn::Set(d, weight[j]), t);
            });
            hn::StoreU(here.a, d, sum + at.a);
            hn::StoreU(here.b, d, sum + at.b);
            hn::StoreU(here.c, d, sum + at.c);
            hn::StoreU(here.d, d, sum + at.d);
        },
        [&](auto d, int node) {
            const auto here = sum_over(d, tension_N, members, node,
                                       [&](int j, auto t) { return hn::Mul(hn::Set(d, weight[j]), t); });
            hn::StoreU(here, d, sum + node);
        });
}

void gains(const GainTerms& terms, int nodes, double* HWY_RESTRICT gain, double* HWY_RESTRICT deviation_N) {
    for_each_node(nodes, [&](auto d, int node) {
        const auto zero = hn::Zero(d);
        const auto one = hn::Set(d, 1.0);
        const auto variance = hn::Set(d, terms.variance);
        const auto fraction = hn::Set(d, terms.fraction);
        const auto covariance = hn::Div(hn::LoadU(d, gain + node), hn::Set(d, terms.members - 1.0));
        const auto deviation = hn::LoadU(d, deviation_N + node);
        const auto node_variance = hn::Mul(deviation, deviation);
        const auto squared = hn::Mul(covariance, covariance);
        const auto chance = hn::Div(
            hn::Mul(hn::Sub(hn::Mul(variance, node_variance), squared), hn::Set(d, terms.chance_variances)),
            hn::Set(d, terms.members - 2.0));
        const auto trust = hn::Min(hn::Sub(one, hn::Div(chance, squared)), one);
        const auto full = hn::Div(hn::Mul(trust, covariance), hn::Set(d, terms.total));
        const auto here = hn::IfThenElse(hn::Gt(squared, chance), full, zero);
        hn::StoreU(here, d, gain + node);
        const auto pull = hn::Mul(fraction, here);
        const auto left = hn::Add(hn::Sub(node_variance, hn::Mul(hn::Mul(hn::Set(d, 2.0), pull), covariance)),
                                  hn::Mul(hn::Mul(pull, pull), variance));
        hn::StoreU(hn::Sqrt(hn::Max(left, zero)), d, deviation_N + node);
    });
}

void pull_nodes(const double* HWY_RESTRICT gain, const double* HWY_RESTRICT pull, int members, int nodes,
                double* const* value) {
    for (int j = 0; j < members; ++j) {
        double* HWY_RESTRICT row = value[j];
        for_each_node(nodes, [&](auto d, int node) {
            const auto moved = hn::Mul(hn::LoadU(d, gain + node), hn::Set(d, pull[j]));
            hn::StoreU(hn::Add(hn::LoadU(d, row + node), moved), d, row + node);
        });
    }
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(moments);
HWY_EXPORT(weighted_sums);
HWY_EXPORT(gains);
HWY_EXPORT(pull_nodes);

void member_moments(MemberRows tension_N, std::span<double> mean_N, std::span<double> deviation_N) {
    HWY_DYNAMIC_DISPATCH(moments)
    (tension_N.data(), static_cast<int>(tension_N.size()), static_cast<int>(mean_N.size()), mean_N.data(),
     deviation_N.data());
}

void weighted_member_sums(MemberRows tension_N, std::span<const double> weight, std::span<double> sum) {
    HWY_DYNAMIC_DISPATCH(weighted_sums)
    (tension_N.data(), weight.data(), static_cast<int>(tension_N.size()), static_cast<int>(sum.size()),
     sum.data());
}

void gains_of_sums(const GainTerms& terms, std::span<double> gain, std::span<double> deviation_N) {
    HWY_DYNAMIC_DISPATCH(gains)(terms, static_cast<int>(gain.size()), gain.data(), deviation_N.data());
}

void add_pulls(std::span<const double> gain, std::span<const double> pull, MemberRows value) {
    HWY_DYNAMIC_DISPATCH(pull_nodes)
    (gain.data(), pull.data(), static_cast<int>(pull.size()), static_cast<int>(gain.size()), value.data());
}

}  // namespace capstan
#endif
