// The laws of engine/effects with a SIMD vector as their number: a bench in each lane.
// Compiled once for each instruction set: Highway's guard instead of pragma once.
#if defined(CAPSTAN_RIG_LANE_LAWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_RIG_LANE_LAWS_INL_H
#undef CAPSTAN_RIG_LANE_LAWS_INL_H
#else
#define CAPSTAN_RIG_LANE_LAWS_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "capstan/rig/bench_cables_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Lanes: a vector of as many benches at once as suits, of which `AllLanes` has the most.
using AllLanes = hn::Vec<hn::CappedTag<double, bench_lanes>>;
template <class Lanes>
using Tag = hn::DFromV<Lanes>;
template <class Lanes>
using Which = hn::Mask<Tag<Lanes>>;
template <class Lanes>
inline constexpr int lanes_at_once = static_cast<int>(hn::MaxLanes(Tag<Lanes>()));
// Two benches are the fewest.
template <class Lanes>
inline constexpr bool has_half = (lanes_at_once<Lanes> > 2);
template <class Lanes>
using Half = hn::Vec<hn::CappedTag<double, has_half<Lanes> ? lanes_at_once<Lanes> / 2 : 2>>;

// The lanes that a condition is of.
template <class Condition, class Lanes = AllLanes>
struct OfCondition : OfCondition<Condition, Half<Lanes>> {};
template <class Condition, class Lanes>
requires std::is_same_v<Condition, Which<Lanes>>
struct OfCondition<Condition, Lanes> {
    using Type = Tag<Lanes>;
};

template <class Lanes>
HWY_INLINE Lanes lanes_of(double value) {
    return hn::Set(Tag<Lanes>(), value);
}
template <class Lanes>
HWY_INLINE Lanes load(const LaneValues& values, int lane) {
    return hn::Load(Tag<Lanes>(), values.of + lane);
}
template <class Lanes>
HWY_INLINE void store(Lanes value, LaneValues& values, int lane) {
    hn::Store(value, Tag<Lanes>(), values.of + lane);
}
template <class Lanes>
HWY_INLINE Which<Lanes> flags_at(const LaneFlags& flags, int lane) {
    LaneValues set;
    for (int each = 0; each < bench_lanes; ++each) set.of[each] = flags.of[each] ? 1.0 : 0.0;
    return hn::Ne(load<Lanes>(set, lane), lanes_of<Lanes>(0.0));
}
template <class Condition>
HWY_INLINE bool none_of(Condition which) {
    return hn::AllFalse(typename OfCondition<Condition>::Type(), which);
}

template <class Lanes, class Kernel>
HWY_INLINE void call_for_active(const LaneFlags& active, int lane, const Kernel& kernel) {
    const auto is_any = [&](int from, int count) {
        return std::find(active.of + from, active.of + from + count, true) != active.of + from + count;
    };
    if constexpr (has_half<Lanes>) {
        constexpr int half = lanes_at_once<Lanes> / 2;
        if (!is_any(lane, half)) return call_for_active<Half<Lanes>>(active, lane + half, kernel);
        if (!is_any(lane + half, half)) return call_for_active<Half<Lanes>>(active, lane, kernel);
    } else if (!is_any(lane, lanes_at_once<Lanes>)) {
        return;
    }
    kernel(Tag<Lanes>(), lane);
}

// Calls `kernel(tag, lane)` for all active lanes, with a vector that is no wider than they need: a few
// benches whose search takes long do not cost as much as all of them.
template <class Kernel>
HWY_INLINE void for_active_lanes(const LaneFlags& active, const Kernel& kernel) {
    for (int lane = 0; lane < bench_lanes; lane += lanes_at_once<AllLanes>)
        call_for_active<AllLanes>(active, lane, kernel);
}

// The operations of effects/law.h.
namespace laws {

template <class Lanes>
HWY_INLINE Lanes constant(double value) {
    return lanes_of<Lanes>(value);
}
template <class Lanes>
HWY_INLINE Lanes exp(Lanes x) {
    return hn::Exp(Tag<Lanes>(), x);
}
template <class Lanes>
HWY_INLINE Lanes pow(Lanes base, Lanes exponent) {
    const Lanes positive = hn::Max(base, lanes_of<Lanes>(1e-300));
    return hn::Exp(Tag<Lanes>(), exponent * hn::Log(Tag<Lanes>(), positive));
}
template <class Lanes>
HWY_INLINE Lanes abs(Lanes x) {
    return hn::Abs(x);
}
template <class Lanes>
HWY_INLINE Lanes negative(Lanes x) {
    return hn::Neg(x);
}
template <class Lanes>
HWY_INLINE Lanes max(Lanes a, Lanes b) {
    return hn::Max(a, b);
}
template <class Lanes>
HWY_INLINE Lanes min(Lanes a, Lanes b) {
    return hn::Min(a, b);
}
template <class Lanes>
HWY_INLINE Lanes saturation(Lanes x) {
    return lanes_of<Lanes>(1.0) - exp(negative(x));
}
template <class Lanes>
HWY_INLINE Lanes quotient(Lanes numerator, Lanes denominator) {
    return numerator * (lanes_of<Lanes>(1.0) / denominator);
}
template <class Lanes>
HWY_INLINE Which<Lanes> is_equal(Lanes a, Lanes b) {
    return hn::Eq(a, b);
}
template <class Lanes>
HWY_INLINE Which<Lanes> is_greater(Lanes a, Lanes b) {
    return hn::Gt(a, b);
}
template <class Condition>
HWY_INLINE Condition either(Condition a, Condition b) {
    return hn::Or(a, b);
}
template <class Condition>
HWY_INLINE Condition is_not(Condition condition) {
    return hn::Not(condition);
}
template <class Condition>
HWY_INLINE bool all(Condition condition) {
    return hn::AllTrue(typename OfCondition<Condition>::Type(), condition);
}
template <class Lanes>
HWY_INLINE Lanes select(Which<Lanes> condition, Lanes if_true, Lanes if_false) {
    return hn::IfThenElse(condition, if_true, if_false);
}

}  // namespace laws
}  // namespace capstan::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

// The law sections again, for lanes.
#pragma push_macro("CAPSTAN_LAWS_BEGIN")
#pragma push_macro("CAPSTAN_LAWS_END")
#pragma push_macro("CAPSTAN_LAW")
#undef CAPSTAN_LAWS_BEGIN
#undef CAPSTAN_LAWS_END
#undef CAPSTAN_LAW
#define CAPSTAN_LAWS_BEGIN  \
    HWY_BEFORE_NAMESPACE(); \
    namespace capstan::bench::HWY_NAMESPACE::laws {
#define CAPSTAN_LAWS_END \
    }                    \
    HWY_AFTER_NAMESPACE();
#define CAPSTAN_LAW HWY_INLINE
#define CAPSTAN_LAWS_FOR_LANES
#include "capstan/effects/bench_effects.h"
#undef CAPSTAN_LAWS_FOR_LANES
#pragma pop_macro("CAPSTAN_LAW")
#pragma pop_macro("CAPSTAN_LAWS_END")
#pragma pop_macro("CAPSTAN_LAWS_BEGIN")

HWY_BEFORE_NAMESPACE();
namespace capstan::bench::HWY_NAMESPACE {

template <class Lanes, template <class> class Law, std::size_t... Index>
HWY_INLINE Law<Lanes> law_at(const LaneParameters<Law>& parameters, int lane, std::index_sequence<Index...>) {
    return {load<Lanes>(parameters.of[Index], lane)...};
}

// Every law of the cable with the parameters of the benches in these lanes.
template <class Lanes, class List>
struct LaneLaws;
template <class Lanes, template <class> class... Law>
struct LaneLaws<Lanes, LawList<Law...>> : Law<Lanes>... {
    HWY_INLINE LaneLaws(const CableLawParameters& parameters, int lane)
        : Law<Lanes>(
              law_at<Lanes, Law>(parameters, lane, std::make_index_sequence<law_parameters<Law>>()))...,
          parameters_(parameters) {}

    // The sum, or the product, of what each law contributes. One that no bench has contributes nothing.
    template <class Contribution>
    HWY_INLINE Lanes sum(const Contribution& contribution) const {
        return (lanes_of<Lanes>(0.0) + ... + of_law<Law>(contribution, 0.0));
    }
    template <class Contribution>
    HWY_INLINE Lanes product(const Contribution& contribution) const {
        return (lanes_of<Lanes>(1.0) * ... * of_law<Law>(contribution, 1.0));
    }

  private:
    template <template <class> class One, class Contribution>
    HWY_INLINE Lanes of_law(const Contribution& contribution, double nothing) const {
        return parameters_.template is_active<One>() ? contribution(static_cast<const One<Lanes>&>(*this))
                                                     : lanes_of<Lanes>(nothing);
    }

    const CableLawParameters& parameters_;
};

// What a law contributes to the cable's friction. A law takes part in as many ways as it has functions of
// these names in its header.
template <class Lanes>
struct SlidingDrag {
    Lanes length_m, time_step_s;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::sliding_drag_N_per_m(law, length_m, time_step_s); })
            return laws::sliding_drag_N_per_m(law, length_m, time_step_s);
        return lanes_of<Lanes>(0.0);
    }
};
template <class Lanes>
struct ConstantDrag {
    Lanes length_m;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::constant_drag_N(law, length_m); })
            return laws::constant_drag_N(law, length_m);
        return lanes_of<Lanes>(0.0);
    }
};
template <class Lanes>
struct AddedFriction {
    Lanes lagging_speed_m_per_s;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::added_friction(law, lagging_speed_m_per_s); })
            return laws::added_friction(law, lagging_speed_m_per_s);
        return lanes_of<Lanes>(0.0);
    }
};
// Where a piece of cable is pressed and has slid, and when.
template <class Lanes>
struct Sliding {
    Lanes lagging_speed_m_per_s, normal_force_N_per_m, bend, session_time_s;
};
template <class Lanes>
struct FrictionFactor {
    const Sliding<Lanes>& sliding;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::friction_factor(law, sliding.normal_force_N_per_m); })
            return laws::friction_factor(law, sliding.normal_force_N_per_m);
        if constexpr (requires { laws::direction_factor(law, sliding.bend); })
            return laws::direction_factor(law, sliding.bend);
        if constexpr (requires { laws::session_factor(law, sliding.session_time_s); })
            return laws::session_factor(law, sliding.session_time_s);
        return lanes_of<Lanes>(1.0);
    }
};

// The cable of these lanes in a step of this length.
template <class Lanes>
struct LaneCable : LaneLaws<Lanes, CableLaws> {
    HWY_INLINE LaneCable(const CablesGroup& group, int lane)
        : LaneLaws<Lanes, CableLaws>(group.laws, lane),
          time_step_s(load<Lanes>(group.time_step_s, lane)),
          loss_steps(load<Lanes>(group.loss_s, lane) / time_step_s),
          dynamic_friction(load<Lanes>(group.dynamic_friction, lane)),
          varies(hn::Ne(load<Lanes>(group.varying_friction, lane), lanes_of<Lanes>(0.0))),
          creeps(group.laws.is_active<CreepLaw>()),
          drags(group.laws.is_active<ViscousFrictionLaw>()),
          has_toe(group.laws.is_active<NonlinearStiffnessLaw>()),
          toe_of_segment{lanes_of<Lanes>(group.segment_m) * this->toe_strain, this->toe_tension_N},
          per_toe_tension(lanes_of<Lanes>(1.0) / this->toe_tension_N) {
        const Lanes stretch_m_per_N = load<Lanes>(group.stretch_m_per_N, lane);
        const Lanes creep_m_per_N = laws::creep_at_rest<Lanes>(*this, stretch_m_per_N);
        const Lanes fraction = laws::creep_fraction<Lanes>(*this, time_step_s);
        creep_stays = lanes_of<Lanes>(1.0) - fraction;
        step_creep_m_per_N = fraction * creep_m_per_N;
        elastic_m_per_N = stretch_m_per_N + step_creep_m_per_N;
        elastic_N_per_m = lanes_of<Lanes>(1.0) / elastic_m_per_N;
    }

    Lanes time_step_s, loss_steps, dynamic_friction;
    Which<Lanes> varies;
    bool creeps, drags, has_toe;  // whether any bench does; those that do not keep their values, bit for bit
    NonlinearStiffnessLaw<Lanes> toe_of_segment;  // its toe "strain" in metres
    Lanes per_toe_tension;
    Lanes creep_stays, step_creep_m_per_N, elastic_m_per_N, elastic_N_per_m;

    // For each metre of NodeGuess::dragged_m. A step of s after one at the mean speed v ends at the speed
    // 3/2 (s - v dt / 3) / dt, by the second-order backward difference (E20).
    HWY_INLINE Lanes sliding_drag_N_per_m(double span_m) const {
        return lanes_of<Lanes>(1.5) * this->sum(SlidingDrag<Lanes>{lanes_of<Lanes>(span_m), time_step_s});
    }
    HWY_INLINE Lanes constant_drag_N(double span_m) const {
        return this->sum(ConstantDrag<Lanes>{lanes_of<Lanes>(span_m)});
    }

    // tanh(mu theta / 2) of E18.
    HWY_INLINE Lanes friction(Lanes wrap_rad, const Sliding<Lanes>& sliding) const {
        const Lanes coefficient =
            dynamic_friction + this->sum(AddedFriction<Lanes>{sliding.lagging_speed_m_per_s});
        const Lanes factor = this->product(FrictionFactor<Lanes>{sliding});
        return hn::Tanh(Tag<Lanes>(), lanes_of<Lanes>(0.5) * coefficient * factor * wrap_rad);
    }
};

template <class Lanes>
struct LaneTension {
    Lanes value_N, per_m;
};

// The tensions of segments of each cable that are stretched by this much beyond their creep (E31, E32). A
// stiffening cable's tension is sought from the last one.
template <class Lanes, int cables>
HWY_INLINE void find_tensions(const LaneCable<Lanes>& cable, const Lanes (&stretch_m)[cables],
                              const Lanes (&last_N)[cables], LaneTension<Lanes> (&found)[cables]) {
    // The stiffness that a slack segment keeps, so that its nodes have a position.
    constexpr double slack_stiffness = 1e-9;
    const Lanes zero = lanes_of<Lanes>(0.0);
    const Lanes one = lanes_of<Lanes>(1.0);
    for (int c = 0; c < cables; ++c) found[c] = {stretch_m[c] * cable.elastic_N_per_m, cable.elastic_N_per_m};
    if (cable.has_toe) {
        const NonlinearStiffnessLaw<Lanes>& law = cable.toe_of_segment;
        constexpr int max_refinements = 4;
        const Lanes near = lanes_of<Lanes>(1e-2);  // the error left is of the order of its cube
        const Lanes half = lanes_of<Lanes>(0.5);
        // Chebyshev's method for the tension in units of the toe's, on the strain, which is concave in
        // tension. A lane rests once it is near, whatever the others need.
        const Lanes elastic_m = cable.elastic_m_per_N * law.toe_tension_N;
        Which<Lanes> toe[cables], open[cables];
        Lanes sought[cables], per_m[cables];
        for (int c = 0; c < cables; ++c) {
            open[c] = toe[c] = hn::And(hn::Gt(law.toe_strain, zero), hn::Gt(stretch_m[c], zero));
            sought[c] = hn::Min(hn::Max(last_N[c], zero), found[c].value_N) * cable.per_toe_tension;
            per_m[c] = zero;
        }
        for (int refinement = 0; refinement < max_refinements; ++refinement) {
            Which<Lanes> any = open[0];
            for (int c = 0; c < cables; ++c) {
                const ToeStrain<Lanes> beyond = laws::toe_strain(law, sought[c]);
                const Lanes rate = one / (elastic_m + beyond.slope);
                const Lanes straight = (stretch_m[c] - (elastic_m * sought[c] + beyond.strain)) * rate;
                const Lanes bent = beyond.slope * rate * straight;  // by how much the rate rises on the way
                const Lanes further = straight + hn::Min(half * bent, one) * straight;
                per_m[c] = hn::IfThenElse(open[c], rate + rate * bent, per_m[c]);
                sought[c] = hn::IfThenElse(open[c], hn::Max(zero, sought[c] + further), sought[c]);
                open[c] = hn::And(open[c], hn::Gt(hn::Abs(further), near));
                any = c == 0 ? open[c] : hn::Or(any, open[c]);
            }
            if (none_of(any)) break;
        }
        for (int c = 0; c < cables; ++c)
            found[c] = {hn::IfThenElse(toe[c], sought[c] * law.toe_tension_N, found[c].value_N),
                        hn::IfThenElse(toe[c], per_m[c] * law.toe_tension_N, found[c].per_m)};
    }
    for (int c = 0; c < cables; ++c) {
        const Lanes kept = hn::IfThenElse(hn::Gt(stretch_m[c], zero), one, lanes_of<Lanes>(slack_stiffness));
        found[c] = {kept * found[c].value_N, kept * found[c].per_m};
    }
}

}  // namespace capstan::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
