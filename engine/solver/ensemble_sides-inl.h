// The sides of a cable in each lane: how far a front goes, and what it writes. Compiled for every SIMD width.
#if defined(CAPSTAN_ENSEMBLE_SIDES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_ENSEMBLE_SIDES_INL
#undef CAPSTAN_ENSEMBLE_SIDES_INL
#else
#define CAPSTAN_ENSEMBLE_SIDES_INL
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cmath>

#include "capstan/solver/ensemble_view.h"
#include "capstan/solver/sliding_front.h"
#include "capstan/solver/sliding_run.h"
#include "capstan/solver/solvable_ends.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using EnsembleTag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<EnsembleTag>;
using Which = hn::Mask<EnsembleTag>;

HWY_INLINE Lanes lanes_of(double value) {
    return hn::Set(EnsembleTag(), value);
}

// One side's motion in every lane. `outward` is +1 at the proximal end, -1 at the distal one, as CableEnd's
// orientation.
struct LaneSide {
    Lanes direction;  // -1, 0, 1
    Lanes count;      // moving nodes
    Lanes tension_N;  // of the end node, where count is less than all nodes
    Lanes displacement_m;
};

// The cables of the members `at` to `at + lanes`, and what each side of them does. View and inputs are
// copies, which no store through a row's pointer can change, so that they stay in registers.
struct LaneSides {
    EnsembleView view;
    EnsembleInputs inputs;
    std::size_t at;
    int last = view.nodes - 1;
    Lanes mean_half = hn::Mul(lanes_of(0.5), hn::Load(EnsembleTag(), view.compliance_m_per_N + at));

    HWY_INLINE Lanes row(const double* rows, int index) const {
        return hn::Load(EnsembleTag(), rows + static_cast<std::size_t>(index) * view.members + at);
    }
    HWY_INLINE Lanes half_of(int segment) const {
        return hn::Mul(mean_half, lanes_of(view.relative_length[segment]));
    }
    HWY_INLINE Lanes tension_N(int node) const { return row(view.tension_N, node); }
    HWY_INLINE Lanes displacement_m(int node) const { return row(view.displacement_m, node); }

    // E4: mu_d holds a segment that slid in the step before, mu_s one that rested.
    HWY_INLINE Lanes holding_ratio(int segment) const {
        const Lanes near = hn::Load(EnsembleTag(), view.proximal_count + at);
        const Lanes far = hn::Load(EnsembleTag(), view.distal_count + at);
        const Which slid = hn::Or(hn::Lt(lanes_of(segment + 1), near),
                                  hn::Gt(lanes_of(segment), hn::Sub(lanes_of(last), far)));
        return hn::IfThenElse(slid, row(view.sliding_ratio, segment), row(view.breakaway_ratio, segment));
    }

    // Tension across a segment, seen outward, for a side that slides in `direction`.
    template <int outward>
    HWY_INLINE Lanes beyond(Lanes tension, int segment, Which grows) const {
        return hn::Mul(tension, hn::IfThenElse(grows, row(view.sliding_ratio, segment),
                                               row(view.inverse_ratio, segment)));
    }
    template <int outward>
    static HWY_INLINE Which grows_outward(Lanes direction) {
        const Lanes zero = lanes_of(0.0);
        return outward > 0 ? hn::Gt(direction, zero) : hn::Lt(direction, zero);
    }

    // driven_direction() of sliding_front.h.
    template <int outward>
    HWY_INLINE Lanes driven(Lanes value, double displacement_factor, double tension_factor) const {
        const int end = outward > 0 ? 0 : last;
        const Lanes by_displacement = hn::Mul(lanes_of(displacement_factor), displacement_m(end));
        const Lanes by_tension = hn::Mul(lanes_of(tension_factor), tension_N(end));
        const Lanes change = hn::Sub(value, hn::Add(by_displacement, by_tension));
        const Lanes scale = hn::Add(hn::Abs(displacement_m(0)), hn::Abs(displacement_m(last)));
        const Lanes rounding =
            hn::Mul(lanes_of(input_rounding), hn::Add(hn::Mul(lanes_of(std::abs(displacement_factor)), scale),
                                                      hn::Add(hn::Abs(by_tension), hn::Abs(value))));
        const Lanes way = hn::CopySign(lanes_of(1.0), change);
        return hn::IfThenElseZero(hn::Gt(hn::Abs(change), rounding), way);
    }

    // E3 and E4: how far the side's front goes. A tension is a pull over a compliance, and tensions are
    // compared by multiplying with the latter, so that each side divides once.
    template <int outward>
    HWY_INLINE LaneSide front(Lanes direction, Lanes value, double displacement_factor, double tension_factor,
                              Lanes first_count) const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Which grows = grows_outward<outward>(direction);
        LaneSide side{direction, zero, zero, zero};
        Which open = hn::Ne(direction, zero);
        side.count = hn::IfThenElseZero(open, lanes_of(view.nodes));
        Lanes ratio = lanes_of(1.0);
        Lanes elongation = zero;
        Lanes stopped_pull = zero;
        Lanes stopped_size = ratio;
        Lanes stopped_anchor = zero;
        Lanes stopped_compliance = zero;
        for (int count = 1; count <= last && !hn::AllFalse(d, open); ++count) {
            const int resting = outward > 0 ? count : last - count;
            const int segment = outward > 0 ? count - 1 : last - count;
            const Lanes half = half_of(segment);
            const Lanes compliance = hn::Add(elongation, hn::Mul(half, ratio));
            const Lanes rest_N = tension_N(resting);
            const Lanes anchor =
                hn::Sub(displacement_m(resting), hn::Mul(lanes_of(outward), hn::Mul(half, rest_N)));
            // Positive: the proximal end is prescribed, the distal one has no negative factors.
            const Lanes size = hn::Sub(hn::Mul(lanes_of(displacement_factor), compliance),
                                       lanes_of(outward * tension_factor));
            const Lanes pull =
                hn::Mul(lanes_of(-outward), hn::Sub(value, hn::Mul(lanes_of(displacement_factor), anchor)));
            const Lanes front = hn::Mul(pull, ratio);
            const Lanes rest = hn::Mul(rest_N, size);
            const Lanes hold = holding_ratio(segment);
            const Which gives_growing = hn::And(grows, hn::Ge(rest, hn::Mul(front, hold)));
            const Which gives_falling = hn::AndNot(grows, hn::Ge(front, hn::Mul(rest, hold)));
            const Which holds =
                hn::AndNot(hn::Or(gives_growing, gives_falling), hn::Ge(lanes_of(count), first_count));
            const Which stops = hn::And(open, holds);
            side.count = hn::IfThenElse(stops, lanes_of(count), side.count);
            stopped_pull = hn::IfThenElse(stops, pull, stopped_pull);
            stopped_size = hn::IfThenElse(stops, size, stopped_size);
            stopped_anchor = hn::IfThenElse(stops, anchor, stopped_anchor);
            stopped_compliance = hn::IfThenElse(stops, compliance, stopped_compliance);
            open = hn::AndNot(stops, open);
            const Lanes next = beyond<outward>(ratio, segment, grows);
            elongation = hn::Add(elongation, hn::Mul(half, hn::Add(ratio, next)));
            ratio = next;
        }
        side.tension_N = hn::Div(stopped_pull, stopped_size);
        side.displacement_m =
            hn::Sub(stopped_anchor, hn::Mul(lanes_of(outward), hn::Mul(stopped_compliance, side.tension_N)));
        return side;
    }

    // Writes the nodes of a side into the next state; the lanes where every one moved its pattern's way (E5)
    // and the last one is held from both sides by its resting neighbour (E4).
    template <int outward>
    HWY_INLINE Which write(const LaneSide& side, Which wanted, Which meets_rest) const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Which grows = grows_outward<outward>(side.direction);
        Lanes tension = side.tension_N;
        Lanes displacement = side.displacement_m;
        Which good = hn::Eq(zero, zero);
        for (int k = 0; k <= last; ++k) {
            const int node = outward > 0 ? k : last - k;
            const Which moving = hn::And(wanted, hn::Lt(lanes_of(k), side.count));
            if (hn::AllFalse(d, moving)) break;
            const Lanes slid = hn::Mul(side.direction, hn::Sub(displacement, displacement_m(node)));
            good = hn::AndNot(hn::And(moving, hn::Lt(slid, lanes_of(-displacement_rounding_m))), good);
            double* next_N = view.next_tension_N + static_cast<std::size_t>(node) * view.members + at;
            double* next_m = view.next_displacement_m + static_cast<std::size_t>(node) * view.members + at;
            hn::Store(hn::IfThenElse(moving, tension, hn::Load(d, next_N)), d, next_N);
            hn::Store(hn::IfThenElse(moving, displacement, hn::Load(d, next_m)), d, next_m);
            if (k == last) break;
            const int segment = outward > 0 ? k : last - 1 - k;
            const int neighbour = outward > 0 ? k + 1 : last - 1 - k;
            const Which front = hn::And(hn::And(moving, meets_rest), hn::Eq(lanes_of(k + 1), side.count));
            const Lanes hold = hn::Mul(holding_ratio(segment), lanes_of(1.0 + tension_rounding));
            const Lanes rest_N = tension_N(neighbour);
            const Which held =
                hn::And(hn::Le(tension, hn::Mul(rest_N, hold)), hn::Le(rest_N, hn::Mul(tension, hold)));
            good = hn::AndNot(hn::AndNot(held, front), good);
            const Lanes next = beyond<outward>(tension, segment, grows);
            displacement = hn::Add(
                displacement, hn::Mul(lanes_of(outward), hn::Mul(half_of(segment), hn::Add(tension, next))));
            tension = next;
        }
        return good;
    }

    // A prescribed displacement is written as prescribed: the rounding of a sum must not drive the next step.
    HWY_INLINE void pin(const LaneSide& near, const LaneSide& far, Lanes proximal_m, Lanes value) const {
        const EnsembleTag d;
        double* first_m = view.next_displacement_m + at;
        hn::Store(hn::IfThenElse(hn::Gt(near.count, lanes_of(0.0)), proximal_m, hn::Load(d, first_m)), d,
                  first_m);
        if (inputs.tension_factor != 0.0) return;
        double* last_m = view.next_displacement_m + static_cast<std::size_t>(last) * view.members + at;
        const Lanes pinned = hn::Div(value, lanes_of(inputs.displacement_factor));
        hn::Store(hn::IfThenElse(hn::Gt(far.count, lanes_of(0.0)), pinned, hn::Load(d, last_m)), d, last_m);
    }
};
}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
