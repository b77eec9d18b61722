#include "capstan/ensemble/ensemble_rows.h"

#include <algorithm>
#include <cmath>

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/ensemble/ensemble_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RowTag = hn::CappedTag<double, 8>;

template <class Term>
HWY_INLINE double row_sum(std::size_t members, const Term& term) {
    const RowTag d;
    auto sum = hn::Zero(d);
    for (std::size_t j = 0; j < members; j += hn::Lanes(d)) sum = hn::Add(sum, term(j));
    return hn::GetLane(hn::SumOfLanes(d, sum));
}

RowMoments row_moments(const double* HWY_RESTRICT row, std::size_t members) {
    const RowTag d;
    const double count = static_cast<double>(members);
    const double mean =
        row_sum(members, [&](std::size_t j) HWY_ATTR { return hn::LoadU(d, row + j); }) / count;
    const auto centre = hn::Set(d, mean);
    const double squares = row_sum(members, [&](std::size_t j) HWY_ATTR {
        const auto off = hn::Sub(hn::LoadU(d, row + j), centre);
        return hn::Mul(off, off);
    });
    return {mean, std::sqrt(squares / (count - 1.0))};
}

// `together` rows at once: their sums do not wait for one another. Distances from the first member, which is
// within a few deviations of the mean, so that one pass finds the mean and the squares; what is sensed adds
// up to none.
template <int together>
void correct_together(const RowCorrection& correction, double* const* rows, std::size_t members) {
    const RowTag d;
    const double* HWY_RESTRICT sensed = correction.sensed.data();
    const double* HWY_RESTRICT moves = correction.moves.data();
    const double seen_fraction = correction.sensed_squares / correction.total_squares;
    const double count = static_cast<double>(members);
    hn::Vec<RowTag> sums[together], own_sums[together], cross_sums[together];
    for (int k = 0; k < together; ++k) sums[k] = own_sums[k] = cross_sums[k] = hn::Zero(d);
    for (std::size_t j = 0; j < members; j += hn::Lanes(d)) {
        const auto seen = hn::LoadU(d, sensed + j);
        for (int k = 0; k < together; ++k) {
            const auto off = hn::Sub(hn::LoadU(d, rows[k] + j), hn::Set(d, rows[k][0]));
            sums[k] = hn::Add(sums[k], off);
            own_sums[k] = hn::MulAdd(off, off, own_sums[k]);
            cross_sums[k] = hn::MulAdd(off, seen, cross_sums[k]);
        }
    }
    for (int k = 0; k < together; ++k) {
        const double sum = hn::GetLane(hn::SumOfLanes(d, sums[k]));
        const double own = hn::GetLane(hn::SumOfLanes(d, own_sums[k])) - sum * sum / count;
        const double cross = hn::GetLane(hn::SumOfLanes(d, cross_sums[k]));
        const double certain = own * correction.sensed_squares;
        if (!(certain > 0.0)) continue;
        const double screened = correction.expected.of_squared(cross * cross / certain);
        const double gain = cross / correction.total_squares;
        const double explained = screened * screened;
        const double closer_by = explained / (1.0 + std::sqrt(1.0 - explained * seen_fraction));
        const auto mean_by = hn::Set(d, gain * screened * correction.off);
        const auto closer = hn::Set(d, gain * closer_by);
        double* row = rows[k];
        for (std::size_t j = 0; j < members; j += hn::Lanes(d)) {
            const auto by = hn::NegMulAdd(closer, hn::LoadU(d, sensed + j), mean_by);
            hn::StoreU(hn::MulAdd(hn::LoadU(d, moves + j), by, hn::LoadU(d, row + j)), d, row + j);
        }
    }
}

void rows_corrected(const RowCorrection& correction, double* const* rows, std::size_t count) {
    const std::size_t members = correction.sensed.size();
    std::size_t at = 0;
    for (; at + 4 <= count; at += 4) correct_together<4>(correction, rows + at, members);
    for (; at < count; ++at) correct_together<1>(correction, rows + at, members);
}

void row_exponentials(const double* HWY_RESTRICT row, double* HWY_RESTRICT result, std::size_t members) {
    const RowTag d;
    for (std::size_t j = 0; j < members; j += hn::Lanes(d))
        hn::StoreU(hn::Exp(d, hn::LoadU(d, row + j)), d, result + j);
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "capstan/solver/chosen_target.h"

namespace capstan {

// With 1,024 members on the configurations over worlds, 14 to 56% of all correlations are beyond 0.3, which
// 64 members can tell from chance; the others are near none.
constexpr double correlated_probability = 0.25;
// Of artanh r where all r between -1 and 1 are as likely: pi^2 / 12.
constexpr double prior_variance = 0.8224670334241132;

// Fisher's z = artanh r has nearly the variance 1 / (members - 3) whatever the true correlation.
double expected_fraction(double correlation, double members, double chance) {
    const double sharpness = (members - 3.0) / chance;
    const double found = std::clamp(std::abs(correlation), 1e-9, 1.0 - 1e-9);
    const double z = std::atanh(found);
    const double spread = sharpness * prior_variance;
    const double kept = spread / (1.0 + spread);
    const double odds = correlated_probability / (1.0 - correlated_probability) / std::sqrt(1.0 + spread) *
                        std::exp(std::min(0.5 * sharpness * z * z * kept, 600.0));
    return std::tanh(kept * z) / found * odds / (1.0 + odds);
}

// The function changes fastest within 1 / members of the square; near 1 it bends as a power below 1, the more
// the fewer the members.
ExpectedFraction::ExpectedFraction(int members, double chance) : intervals_(8.0 * std::max(members, 256)) {
    for (double k = 0.0; k <= intervals_; ++k)
        table_.push_back(expected_fraction(std::sqrt(k / intervals_), members, chance));
    table_.push_back(table_.back());
}

HWY_EXPORT(row_moments);
HWY_EXPORT(rows_corrected);
HWY_EXPORT(row_exponentials);

RowMoments moments_of_row(std::span<const double> row) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(row_moments); });
    return chosen(row.data(), row.size());
}

void correct_rows(const RowCorrection& correction, std::span<double* const> rows) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(rows_corrected); });
    chosen(correction, rows.data(), rows.size());
}

void exp_row(std::span<const double> row, std::span<double> result) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(row_exponentials); });
    chosen(row.data(), result.data(), row.size());
}

}  // namespace capstan
#endif
