// Members are lanes, so that every processor computes the same bits.
#include "capstan/ensemble/cable_rows.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/ensemble/cable_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using MemberTag = hn::CappedTag<double, 8>;

void clip_rows(const CableRows& rows, double* highest_N) {
    const MemberTag d;
    const auto zero = hn::Zero(d);
    for (std::size_t j = 0; j < rows.members; j += hn::Lanes(d)) {
        auto highest = zero;
        for (int node = 0; node < rows.nodes; ++node) {
            double* const at = rows.tension_N + static_cast<std::size_t>(node) * rows.members + j;
            const auto clipped = hn::Max(hn::LoadU(d, at), zero);
            highest = hn::Max(highest, clipped);
            hn::StoreU(clipped, d, at);
        }
        hn::StoreU(highest, d, highest_N + j);
    }
}

void place_rows(const CableRows& rows, const double* distal_m) {
    const MemberTag d;
    const int last = rows.nodes - 1;
    for (std::size_t j = 0; j < rows.members; j += hn::Lanes(d)) {
        const auto is_slack = hn::Ne(hn::LoadU(d, rows.slack + j), hn::Zero(d));
        const auto compliance = hn::LoadU(d, rows.compliance_m_per_N + j);
        auto next_m = hn::LoadU(d, distal_m + j);
        auto next_N = hn::Zero(d);
        for (int node = last; node >= 0; --node) {
            const std::size_t at = static_cast<std::size_t>(node) * rows.members + j;
            const auto here_N = hn::LoadU(d, rows.tension_N + at);
            if (node < last) {
                const auto half = hn::Set(d, 0.5 * rows.relative_length[node]);
                next_m = hn::Sub(next_m, hn::Mul(hn::Mul(half, compliance), hn::Add(here_N, next_N)));
            }
            next_N = here_N;
            double* const place = rows.displacement_m + at;
            hn::StoreU(hn::IfThenElse(is_slack, hn::LoadU(d, place), next_m), d, place);
        }
    }
}

void rows_stretched(const CableRows& rows, const double* far_end_by_m, const double* proximal_by_m,
                    double spring_m_per_N) {
    const MemberTag d;
    const int segments = rows.nodes - 1;
    const auto spring = hn::Set(d, spring_m_per_N);
    for (std::size_t j = 0; j < rows.members; j += hn::Lanes(d)) {
        const auto is_slack = hn::Ne(hn::LoadU(d, rows.slack + j), hn::Zero(d));
        const auto compliance = hn::LoadU(d, rows.compliance_m_per_N + j);
        const auto far_by = hn::LoadU(d, far_end_by_m + j);
        const auto all = hn::Add(hn::Mul(hn::Set(d, segments), compliance), spring);
        const auto further_N = hn::Div(hn::Sub(far_by, hn::LoadU(d, proximal_by_m + j)), all);
        double relative_m_per_N = 0.0;  // beyond the distal end, in compliances
        for (int node = segments; node >= 0; --node) {
            const std::size_t at = static_cast<std::size_t>(node) * rows.members + j;
            double* const place = rows.displacement_m + at;
            double* const pull = rows.tension_N + at;
            const auto before_m = hn::LoadU(d, place);
            const auto before_N = hn::LoadU(d, pull);
            const auto beyond = hn::Add(spring, hn::Mul(hn::Set(d, relative_m_per_N), compliance));
            const auto now_m = hn::Add(before_m, hn::Sub(far_by, hn::Mul(further_N, beyond)));
            const auto now_N = hn::Max(hn::Add(before_N, further_N), hn::Zero(d));
            hn::StoreU(hn::IfThenElse(is_slack, before_m, now_m), d, place);
            hn::StoreU(hn::IfThenElse(is_slack, before_N, now_N), d, pull);
            if (node > 0) relative_m_per_N += rows.relative_length[node - 1];
        }
    }
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "capstan/solver/chosen_target.h"

namespace capstan {

HWY_EXPORT(clip_rows);
HWY_EXPORT(place_rows);
HWY_EXPORT(rows_stretched);

void clip_tensions(const CableRows& rows, double* highest_N) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(clip_rows); });
    chosen(rows, highest_N);
}

void place_nodes(const CableRows& rows, const double* distal_m) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(place_rows); });
    chosen(rows, distal_m);
}

void stretch_rows(const CableRows& rows, const double* far_end_by_m, const double* proximal_by_m,
                  double spring_m_per_N) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(rows_stretched); });
    chosen(rows, far_end_by_m, proximal_by_m, spring_m_per_N);
}

}  // namespace capstan
#endif
