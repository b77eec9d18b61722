// Where a search over all sensor sets spends its time, so it runs on whatever SIMD the processor has
// (Highway, chosen at run time). Nothing is summed across lanes: every processor gives the same bits.
#include "capstan/estimation/curve_peak.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/estimation/curve_peak.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;  // points are a multiple of 8

void add_rows(const double* HWY_RESTRICT before, const double* HWY_RESTRICT sensor, int points,
              double* HWY_RESTRICT sum) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int k = 0; k < points; k += lanes) {
        hn::StoreU(hn::Add(hn::LoadU(d, before + k), hn::LoadU(d, sensor + k)), d, sum + k);
    }
}

// The first index at which the value is that of all lanes' largest.
int first_index_of(const double* HWY_RESTRICT value, int points, hn::Vec<Tag> largest) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto top = hn::MaxOfLanes(d, largest);
    for (int k = 0; k < points; k += lanes) {
        const auto at_top = hn::FindFirstTrue(d, hn::Eq(hn::LoadU(d, value + k), top));
        if (at_top >= 0) return k + static_cast<int>(at_top);
    }
    return 0;  // only where a value is not a number
}

// Of the lanes of two running maxima the first index at which the largest value was met.
int first_of(hn::Vec<Tag> largest, hn::Vec<Tag> at, hn::Vec<Tag> other_largest, hn::Vec<Tag> other_at) {
    const Tag d;
    const auto top = hn::MaxOfLanes(d, hn::Max(largest, other_largest));
    const auto nowhere = hn::Set(d, 1e300);
    const auto first = hn::Min(hn::IfThenElse(hn::Eq(largest, top), at, nowhere),
                               hn::IfThenElse(hn::Eq(other_largest, top), other_at, nowhere));
    const double index = hn::GetLane(hn::MinOfLanes(d, first));
    return index < 1e300 ? static_cast<int>(index) : 0;  // 0 only where a value is not a number
}

// Nothing is looked for in a second pass and no branch depends on where the peak is: two running maxima, each
// with the index at which it was met.
int add_rows_and_find(const double* HWY_RESTRICT before, const double* HWY_RESTRICT sensor, int points,
                      double* HWY_RESTRICT sum) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto add = [&](int k) {
        const auto here = hn::Add(hn::LoadU(d, before + k), hn::LoadU(d, sensor + k));
        hn::StoreU(here, d, sum + k);
        return here;
    };
    const auto step = hn::Set(d, 2.0 * lanes);
    auto even = add(0);
    auto even_index = hn::Iota(d, 0.0);
    auto even_at = even_index;
    auto odd = even;
    auto odd_index = hn::Iota(d, static_cast<double>(lanes));
    auto odd_at = even_at;
    int k = lanes;
    for (; k + lanes < points; k += 2 * lanes) {
        const auto left = add(k);
        const auto right = add(k + lanes);
        even_index = hn::Add(even_index, step);
        odd_at = hn::IfThenElse(hn::Gt(left, odd), odd_index, odd_at);
        odd = hn::Max(odd, left);
        odd_index = hn::Add(odd_index, step);
        even_at = hn::IfThenElse(hn::Gt(right, even), even_index, even_at);
        even = hn::Max(even, right);
    }
    if (k < points) {
        const auto left = add(k);
        odd_at = hn::IfThenElse(hn::Gt(left, odd), odd_index, odd_at);
        odd = hn::Max(odd, left);
    }
    return first_of(even, even_at, odd, odd_at);
}

int first_largest(const double* HWY_RESTRICT value, int points) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    auto largest = hn::LoadU(d, value);
    for (int k = lanes; k < points; k += lanes) largest = hn::Max(largest, hn::LoadU(d, value + k));
    return first_index_of(value, points, largest);
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(add_rows);
HWY_EXPORT(add_rows_and_find);
HWY_EXPORT(first_largest);

void add_log_likelihood(std::span<const double> before, std::span<const double> sensor,
                        std::span<double> result) {
    HWY_DYNAMIC_DISPATCH(add_rows)
    (before.data(), sensor.data(), static_cast<int>(result.size()), result.data());
}

int add_log_likelihood_and_find_peak(std::span<const double> before, std::span<const double> sensor,
                                     std::span<double> result) {
    return HWY_DYNAMIC_DISPATCH(add_rows_and_find)(before.data(), sensor.data(),
                                                   static_cast<int>(result.size()), result.data());
}

int likeliest_point(std::span<const double> log_likelihood) {
    return HWY_DYNAMIC_DISPATCH(first_largest)(log_likelihood.data(),
                                               static_cast<int>(log_likelihood.size()));
}

}  // namespace capstan
#endif
