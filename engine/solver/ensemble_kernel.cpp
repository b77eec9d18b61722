// A cable in each lane. A member never depends on its neighbours, so the number of lanes of the processor
// changes nothing but the last digit of the exponentials.
#include "capstan/solver/ensemble_view.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/solver/ensemble_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "capstan/solver/ensemble_turn-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {

void make_ratios(const EnsembleView& view) {
    const EnsembleTag d;
    const std::size_t count = view.members * static_cast<std::size_t>(view.nodes - 1);
    const Lanes one = lanes_of(1.0);
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
        const Lanes exponent = hn::Load(d, view.exponent + k);
        Lanes ratio = one;
        Lanes inverse = one;
        Lanes breakaway = one;
        if (!hn::AllTrue(d, hn::Eq(exponent, hn::Zero(d)))) {
            ratio = hn::Exp(d, exponent);
            inverse = hn::Div(one, ratio);
            breakaway = view.static_to_dynamic == 1.0
                            ? ratio
                            : hn::Exp(d, hn::Mul(exponent, lanes_of(view.static_to_dynamic)));
        }
        hn::Store(ratio, d, view.sliding_ratio + k);
        hn::Store(inverse, d, view.inverse_ratio + k);
        hn::Store(breakaway, d, view.breakaway_ratio + k);
    }
}

struct LaneStep : LaneTurn {
    HWY_INLINE void run() const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Lanes all_nodes = lanes_of(view.nodes);
        const Lanes proximal_m = hn::Add(displacement_m(0), lanes_of(inputs.proximal_increment_m));
        const Lanes value = hn::LoadU(d, inputs.value + at);
        const double u = inputs.displacement_factor;
        const double t = inputs.tension_factor;
        double* const motion[] = {view.proximal_direction + at, view.proximal_count + at,
                                  view.distal_direction + at, view.distal_count + at};

        const Lanes near_way = driven<1>(proximal_m, 1.0, 0.0);
        const Lanes far_way = driven<-1>(value, u, t);
        const auto remembered = [&](Lanes way, const double* direction, const double* count) HWY_ATTR {
            return hn::IfThenElseZero(hn::Eq(way, hn::Load(d, direction)), hn::Load(d, count));
        };
        LaneSide near = front<1>(near_way, proximal_m, 1.0, 0.0, remembered(near_way, motion[0], motion[1]));
        LaneSide far = front<-1>(far_way, value, u, t, remembered(far_way, motion[2], motion[3]));

        // E1, E2 and E6 where the sides meet and are driven one way.
        const Which meet = hn::Ge(hn::Add(near.count, far.count), all_nodes);
        const Which against = hn::Lt(hn::Mul(near_way, far_way), zero);
        // Fronts that meet in one segment may leave its middle at rest (E8): rare, and left to the search.
        const Which one_way = hn::Gt(hn::Mul(near_way, far_way), zero);
        const Which in_one_segment = hn::And(one_way, hn::Eq(hn::Add(near.count, far.count), all_nodes));
        Lanes way = hn::IfThenElse(hn::Ne(near_way, zero), near_way, far_way);
        Which opposed = hn::And(meet, against);
        Which mass = hn::AndNot(against, meet);
        if (!hn::AllFalse(d, opposed)) {
            Lanes mass_way = zero;
            opposed = oppose(opposed, proximal_m, value, near, far, mass_way);
            const Which turned = hn::Ne(mass_way, zero);
            way = hn::IfThenElse(turned, mass_way, way);
            mass = hn::Or(mass, turned);
        }
        Which good = hn::AndNot(hn::AndNot(hn::Or(opposed, mass), meet), hn::Not(in_one_segment));
        if (!hn::AllFalse(d, mass)) {
            const Which grows = grows_outward<1>(way);
            Lanes ratio = lanes_of(1.0);
            Lanes elongation = zero;
            for (int segment = 0; segment < last; ++segment) {
                const Lanes next = beyond<1>(ratio, segment, grows);
                elongation = hn::Add(elongation, hn::Mul(half_of(segment), hn::Add(ratio, next)));
                ratio = next;
            }
            const Lanes tension = end_tension(proximal_m, value, ratio, elongation);
            good = hn::AndNot(hn::And(mass, hn::Not(hn::Gt(tension, zero))), good);
            near.direction = hn::IfThenElse(mass, way, near.direction);
            near.count = hn::IfThenElse(mass, all_nodes, near.count);
            near.tension_N = hn::IfThenElse(mass, tension, near.tension_N);
            near.displacement_m = hn::IfThenElse(mass, proximal_m, near.displacement_m);
            far.direction = hn::IfThenElse(mass, way, far.direction);
        }
        for (int node = 0; node <= last; ++node) {
            const std::size_t to = static_cast<std::size_t>(node) * view.members + at;
            hn::Store(tension_N(node), d, view.next_tension_N + to);
            hn::Store(displacement_m(node), d, view.next_displacement_m + to);
        }
        const Which everywhere = hn::Eq(zero, zero);
        const Which meets_rest = hn::Not(opposed);
        good = hn::And(good, write<1>(near, everywhere, meets_rest));
        good = hn::And(good, write<-1>(far, hn::Not(mass), meets_rest));
        far.count = hn::IfThenElse(mass, all_nodes, far.count);
        pin(near, far, proximal_m, value);

        const Lanes size = hn::Add(hn::Abs(near.tension_N), hn::Abs(far.tension_N));
        good = hn::And(good, hn::Le(size, lanes_of(largest_number)));
        // A slack member has no front; the search knows about it.
        good = hn::And(good, hn::Eq(hn::Load(d, inputs.left + at), zero));

        for (int node = 0; node <= last; ++node) {
            const std::size_t to = static_cast<std::size_t>(node) * view.members + at;
            hn::Store(hn::IfThenElse(good, hn::Load(d, view.next_tension_N + to), tension_N(node)), d,
                      view.tension_N + to);
            hn::Store(hn::IfThenElse(good, hn::Load(d, view.next_displacement_m + to), displacement_m(node)),
                      d, view.displacement_m + to);
        }
        const Lanes moved[] = {near.direction, near.count, far.direction, far.count};
        for (int k = 0; k < 4; ++k)
            hn::Store(hn::IfThenElse(good, moved[k], hn::Load(d, motion[k])), d, motion[k]);
        hn::Store(hn::IfThenElse(good, zero, lanes_of(1.0)), d, inputs.left + at);
    }
};

void step_members(const EnsembleView& view, const EnsembleInputs& inputs) {
    for (std::size_t at = 0; at < view.members; at += hn::Lanes(EnsembleTag()))
        LaneStep{{{view, inputs, at}}}.run();
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "capstan/solver/chosen_target.h"

namespace capstan {

HWY_EXPORT(make_ratios);
HWY_EXPORT(step_members);

void make_ensemble_ratios(const EnsembleView& view) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(make_ratios); });
    chosen(view);
}

void step_ensemble(const EnsembleView& view, const EnsembleInputs& inputs) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(step_members); });
    chosen(view, inputs);
}

}  // namespace capstan
#endif
