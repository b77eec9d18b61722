// Sides that are driven against each other and meet: where the direction changes (E7). Compiled for every
// SIMD width.
#if defined(CAPSTAN_ENSEMBLE_TURN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_ENSEMBLE_TURN_INL
#undef CAPSTAN_ENSEMBLE_TURN_INL
#else
#define CAPSTAN_ENSEMBLE_TURN_INL
#endif

#include "capstan/solver/ensemble_sides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
// What opposed_motion() does, for a cable in each lane.
struct LaneTurn : LaneSides {
    // What E7 needs of the segment that the zero-velocity point lies in: p and q are its nodes.
    struct Turn {
        Lanes p_ratio, p_elongation;  // of the proximal side's table
        Lanes q_ratio, q_elongation;  // of the distal side's
        Lanes p_before_m, q_before_m;
        Lanes exponent, half;
    };
    struct TurnEnds {
        Lanes mismatch_m;  // velocity at the assumed zero-velocity point
        Lanes tension_N;   // of the proximal end
        Lanes distal_N;
        Lanes distal_m;
    };
    HWY_INLINE Lanes end_tension(Lanes proximal_m, Lanes value, Lanes ratio, Lanes elongation) const {
        const Lanes u = lanes_of(inputs.displacement_factor);
        const Lanes factor = hn::Add(hn::Mul(u, elongation), hn::Mul(lanes_of(inputs.tension_factor), ratio));
        return hn::Div(hn::Sub(value, hn::Mul(u, proximal_m)), factor);
    }
    // opposed_at() of candidate.h and the mismatch of opposed_motion.cpp.
    HWY_INLINE TurnEnds turn_at(const Turn& turn, Lanes fraction, Lanes direction, Lanes proximal_m,
                                Lanes value) const {
        const EnsembleTag d;
        const Lanes one = lanes_of(1.0);
        const Lanes shift = hn::Sub(hn::Add(fraction, fraction), one);
        const Lanes across = hn::Exp(d, hn::Mul(hn::Mul(turn.exponent, direction), shift));
        const Lanes ratio = hn::Div(hn::Mul(turn.p_ratio, across), turn.q_ratio);
        const Lanes p_front = hn::Add(turn.p_elongation, hn::Mul(turn.half, turn.p_ratio));
        const Lanes q_front = hn::Add(turn.q_elongation, hn::Mul(turn.half, turn.q_ratio));
        const Lanes elongation = hn::Add(p_front, hn::Mul(ratio, q_front));
        TurnEnds ends;
        ends.tension_N = end_tension(proximal_m, value, ratio, elongation);
        ends.distal_N = hn::Mul(ends.tension_N, ratio);
        ends.distal_m = hn::Add(proximal_m, hn::Mul(ends.tension_N, elongation));
        const Lanes p_m = hn::Add(proximal_m, hn::Mul(ends.tension_N, turn.p_elongation));
        const Lanes q_m = hn::Sub(ends.distal_m, hn::Mul(ends.distal_N, turn.q_elongation));
        ends.mismatch_m =
            hn::Mul(direction, hn::Add(hn::Mul(hn::Sub(one, fraction), hn::Sub(p_m, turn.p_before_m)),
                                       hn::Mul(fraction, hn::Sub(q_m, turn.q_before_m))));
        return ends;
    }

    // E7 where the sides meet and are driven against each other, as opposed_motion(): the segment in which
    // the direction changes, then a bracketed secant (Illinois) for the place in it. The lanes that have one;
    // where all slides instead, `mass_way` says which way. The next state serves as workspace.
    HWY_INLINE Which oppose(Which wanted, Lanes proximal_m, Lanes value, LaneSide& near, LaneSide& far,
                            Lanes& mass_way) const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Lanes one = lanes_of(1.0);
        const Lanes direction = near.direction;
        const Which grows = grows_outward<1>(direction);
        const auto stored = [&](double* rows, int node) HWY_ATTR {
            return rows + static_cast<std::size_t>(node) * view.members + at;
        };
        Lanes ratio = one;
        Lanes elongation = zero;
        for (int node = last; node >= 0; --node) {
            hn::Store(ratio, d, stored(view.next_tension_N, node));
            hn::Store(elongation, d, stored(view.next_displacement_m, node));
            if (node == 0) break;
            const Lanes next = beyond<-1>(ratio, node - 1, grows);
            elongation = hn::Add(elongation, hn::Mul(half_of(node - 1), hn::Add(ratio, next)));
            ratio = next;
        }

        ratio = one;
        elongation = zero;
        const Lanes pull_of_all = hn::Sub(value, hn::Mul(lanes_of(inputs.displacement_factor), proximal_m));
        Turn turn{one, zero, one, zero, zero, zero, zero, zero};
        Lanes count = zero;
        Lanes ratio_before = one;
        Lanes elongation_before = zero;
        Which open = wanted;
        Which found = hn::Lt(one, zero);
        for (int node = 0; node <= last && !hn::AllFalse(d, open); ++node) {
            const Lanes far_ratio = hn::Load(d, stored(view.next_tension_N, node));
            const Lanes far_elongation = hn::Load(d, stored(view.next_displacement_m, node));
            // Which way the node moves if the direction changes there: the signs of end_tension() and of the
            // node's increment, without their divisions.
            const Lanes pull = hn::Mul(pull_of_all, far_ratio);
            const Lanes all_elongation =
                hn::Add(hn::Mul(elongation, far_ratio), hn::Mul(ratio, far_elongation));
            const Lanes size = hn::Add(hn::Mul(lanes_of(inputs.displacement_factor), all_elongation),
                                       hn::Mul(lanes_of(inputs.tension_factor), ratio));
            const Lanes ahead_m = hn::Sub(displacement_m(node), proximal_m);
            const Lanes moved =
                hn::Mul(direction, hn::Sub(hn::Mul(pull, elongation), hn::Mul(ahead_m, size)));
            const Which with_proximal = hn::And(hn::Gt(pull, zero), hn::Gt(moved, zero));
            const Which stops = hn::AndNot(with_proximal, open);
            if (node == 0) {
                mass_way = hn::IfThenElse(stops, hn::Neg(direction), mass_way);
            } else {
                const auto take = [&](Lanes& to, Lanes from)
                                      HWY_ATTR { to = hn::IfThenElse(stops, from, to); };
                take(turn.p_ratio, ratio_before);
                take(turn.p_elongation, elongation_before);
                take(turn.q_ratio, far_ratio);
                take(turn.q_elongation, far_elongation);
                take(turn.p_before_m, displacement_m(node - 1));
                take(turn.q_before_m, displacement_m(node));
                take(turn.exponent, row(view.exponent, node - 1));
                take(turn.half, half_of(node - 1));
                take(count, lanes_of(node));
                found = hn::Or(found, stops);
            }
            open = hn::And(open, with_proximal);
            if (node == last) break;
            ratio_before = ratio;
            elongation_before = elongation;
            const Lanes next = beyond<1>(ratio, node, grows);
            elongation = hn::Add(elongation, hn::Mul(half_of(node), hn::Add(ratio, next)));
            ratio = next;
        }
        mass_way = hn::IfThenElse(open, direction, mass_way);
        if (hn::AllFalse(d, found)) return found;

        Lanes low = zero;
        Lanes high = one;
        Lanes at_low = turn_at(turn, low, direction, proximal_m, value).mismatch_m;
        TurnEnds ends = turn_at(turn, high, direction, proximal_m, value);
        Lanes at_high = ends.mismatch_m;
        Lanes fraction = one;
        Lanes last_side = zero;
        Which running = hn::And(found, hn::Lt(at_high, zero));
        for (int iteration = 0; iteration < 100 && !hn::AllFalse(d, running); ++iteration) {
            const Lanes share = hn::Div(at_low, hn::Sub(at_low, at_high));
            fraction = hn::IfThenElse(running, hn::Add(low, hn::Mul(hn::Sub(high, low), share)), fraction);
            ends = turn_at(turn, fraction, direction, proximal_m, value);
            const Lanes middle = ends.mismatch_m;
            // Below the rounding of any displacement.
            const Which stands = hn::Or(hn::Eq(fraction, low), hn::Eq(fraction, high));
            running = hn::AndNot(hn::Or(hn::Lt(hn::Abs(middle), lanes_of(1e-18)), stands), running);
            const Which is_low = hn::And(running, hn::Gt(middle, zero));
            const Which is_high = hn::AndNot(is_low, running);
            low = hn::IfThenElse(is_low, fraction, low);
            at_low = hn::IfThenElse(is_low, middle, at_low);
            high = hn::IfThenElse(is_high, fraction, high);
            at_high = hn::IfThenElse(is_high, middle, at_high);
            const Lanes halved_high = hn::Mul(at_high, lanes_of(0.5));
            const Lanes halved_low = hn::Mul(at_low, lanes_of(0.5));
            at_high = hn::IfThenElse(hn::And(is_low, hn::Gt(last_side, zero)), halved_high, at_high);
            at_low = hn::IfThenElse(hn::And(is_high, hn::Lt(last_side, zero)), halved_low, at_low);
            last_side = hn::IfThenElse(is_low, one, hn::IfThenElse(is_high, hn::Neg(one), last_side));
        }
        found = hn::And(found, hn::Gt(ends.tension_N, zero));
        near.count = hn::IfThenElse(found, count, near.count);
        near.tension_N = hn::IfThenElse(found, ends.tension_N, near.tension_N);
        near.displacement_m = hn::IfThenElse(found, proximal_m, near.displacement_m);
        far.count = hn::IfThenElse(found, hn::Sub(lanes_of(view.nodes), count), far.count);
        far.tension_N = hn::IfThenElse(found, ends.distal_N, far.tension_N);
        far.displacement_m = hn::IfThenElse(found, ends.distal_m, far.displacement_m);
        return found;
    }
};
}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
