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

#include <utility>

#include "capstan/rig/bench_cables_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using BenchTag = hn::CappedTag<double, bench_lanes>;
using Lanes = hn::Vec<BenchTag>;
using Which = hn::Mask<BenchTag>;
inline constexpr int lanes_at_once = static_cast<int>(hn::MaxLanes(BenchTag()));

HWY_INLINE Lanes lanes_of(double value) {
    return hn::Set(BenchTag(), value);
}
HWY_INLINE Lanes load(const LaneValues& values, int lane) {
    return hn::Load(BenchTag(), values.of + lane);
}
HWY_INLINE void store(Lanes value, LaneValues& values, int lane) {
    hn::Store(value, BenchTag(), values.of + lane);
}
HWY_INLINE Which flags_at(const LaneFlags& flags, int lane) {
    LaneValues set;
    for (int each = 0; each < bench_lanes; ++each) set.of[each] = flags.of[each] ? 1.0 : 0.0;
    return hn::Ne(load(set, lane), lanes_of(0.0));
}
HWY_INLINE bool none_of(Which which) {
    return hn::AllFalse(BenchTag(), which);
}

// The operations of effects/law.h.
namespace laws {

template <class Number>
HWY_INLINE Lanes constant(double value) {
    return lanes_of(value);
}
HWY_INLINE Lanes exp(Lanes x) {
    return hn::Exp(BenchTag(), x);
}
HWY_INLINE Lanes pow(Lanes base, Lanes exponent) {
    const Lanes positive = hn::Max(base, lanes_of(1e-300));
    return hn::Exp(BenchTag(), exponent * hn::Log(BenchTag(), positive));
}
HWY_INLINE Lanes abs(Lanes x) {
    return hn::Abs(x);
}
HWY_INLINE Lanes negative(Lanes x) {
    return hn::Neg(x);
}
HWY_INLINE Lanes max(Lanes a, Lanes b) {
    return hn::Max(a, b);
}
HWY_INLINE Lanes min(Lanes a, Lanes b) {
    return hn::Min(a, b);
}
HWY_INLINE Lanes saturation(Lanes x) {
    return lanes_of(1.0) - exp(negative(x));
}
HWY_INLINE Lanes quotient(Lanes numerator, Lanes denominator) {
    return numerator * (lanes_of(1.0) / denominator);
}
HWY_INLINE Which is_equal(Lanes a, Lanes b) {
    return hn::Eq(a, b);
}
HWY_INLINE Which is_greater(Lanes a, Lanes b) {
    return hn::Gt(a, b);
}
HWY_INLINE Which either(Which a, Which b) {
    return hn::Or(a, b);
}
HWY_INLINE bool all(Which condition) {
    return hn::AllTrue(BenchTag(), condition);
}
HWY_INLINE Lanes select(Which condition, Lanes if_true, Lanes if_false) {
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

template <template <class> class Law, std::size_t... Index>
HWY_INLINE Law<Lanes> law_at(const LaneParameters<Law>& parameters, int lane, std::index_sequence<Index...>) {
    return {load(parameters.of[Index], lane)...};
}

// Every law of the cable with the parameters of the benches in these lanes.
template <class List>
struct LaneLaws;
template <template <class> class... Law>
struct LaneLaws<LawList<Law...>> : Law<Lanes>... {
    HWY_INLINE LaneLaws(const CableLawParameters& parameters, int lane)
        : Law<Lanes>(law_at<Law>(parameters, lane, std::make_index_sequence<law_parameters<Law>>()))...,
          parameters_(parameters) {}

    // The sum, or the product, of what each law contributes. One that no bench has contributes nothing.
    template <class Contribution>
    HWY_INLINE Lanes sum(const Contribution& contribution) const {
        return (lanes_of(0.0) + ... + of_law<Law>(contribution, 0.0));
    }
    template <class Contribution>
    HWY_INLINE Lanes product(const Contribution& contribution) const {
        return (lanes_of(1.0) * ... * of_law<Law>(contribution, 1.0));
    }

  private:
    template <template <class> class One, class Contribution>
    HWY_INLINE Lanes of_law(const Contribution& contribution, double nothing) const {
        return parameters_.template is_active<One>() ? contribution(static_cast<const One<Lanes>&>(*this))
                                                     : lanes_of(nothing);
    }

    const CableLawParameters& parameters_;
};

// What a law contributes to the cable's friction. A law takes part in as many ways as it has functions of
// these names in its header.
struct SlidingDrag {
    Lanes length_m, time_step_s;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::sliding_drag_N_per_m(law, length_m, time_step_s); })
            return laws::sliding_drag_N_per_m(law, length_m, time_step_s);
        return lanes_of(0.0);
    }
};
struct ConstantDrag {
    Lanes length_m;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::constant_drag_N(law, length_m); })
            return laws::constant_drag_N(law, length_m);
        return lanes_of(0.0);
    }
};
struct AddedFriction {
    Lanes lagging_speed_m_per_s;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::added_friction(law, lagging_speed_m_per_s); })
            return laws::added_friction(law, lagging_speed_m_per_s);
        return lanes_of(0.0);
    }
};
struct FrictionFactor {
    Lanes normal_force_N_per_m;
    template <class Law>
    HWY_INLINE Lanes operator()(const Law& law) const {
        if constexpr (requires { laws::friction_factor(law, normal_force_N_per_m); })
            return laws::friction_factor(law, normal_force_N_per_m);
        return lanes_of(1.0);
    }
};

// The cable of these lanes in a step of this length.
struct LaneCable : LaneLaws<CableLaws> {
    HWY_INLINE LaneCable(const CablesGroup& group, int lane)
        : LaneLaws<CableLaws>(group.laws, lane),
          time_step_s(lanes_of(group.time_step_s)),
          dynamic_friction(load(group.dynamic_friction, lane)),
          varies(hn::Ne(load(group.varying_friction, lane), lanes_of(0.0))),
          creeps(group.laws.is_active<CreepLaw>()),
          has_toe(group.laws.is_active<NonlinearStiffnessLaw>()),
          toe_of_segment{lanes_of(group.segment_m) * this->toe_strain, this->toe_tension_N} {
        const Lanes stretch_m_per_N = load(group.stretch_m_per_N, lane);
        const Lanes creep_m_per_N = laws::creep_at_rest<Lanes>(*this, stretch_m_per_N);
        const Lanes fraction = laws::creep_fraction<Lanes>(*this, time_step_s);
        creep_stays = lanes_of(1.0) - fraction;
        step_creep_m_per_N = fraction * creep_m_per_N;
        elastic_m_per_N = stretch_m_per_N + step_creep_m_per_N;
        elastic_N_per_m = lanes_of(1.0) / elastic_m_per_N;
    }

    Lanes time_step_s, dynamic_friction;
    Which varies;
    bool creeps, has_toe;  // whether any bench does; those that do not keep their values, bit for bit
    NonlinearStiffnessLaw<Lanes> toe_of_segment;  // its toe "strain" in metres
    Lanes creep_stays, step_creep_m_per_N, elastic_m_per_N, elastic_N_per_m;

    HWY_INLINE Lanes sliding_drag_N_per_m(double span_m) const {
        return sum(SlidingDrag{lanes_of(span_m), time_step_s});
    }
    HWY_INLINE Lanes constant_drag_N(double span_m) const { return sum(ConstantDrag{lanes_of(span_m)}); }

    // tanh(mu theta / 2) of E18.
    HWY_INLINE Lanes friction(Lanes wrap_rad, Lanes lagging_speed, Lanes normal_force_N_per_m) const {
        const Lanes coefficient = dynamic_friction + sum(AddedFriction{lagging_speed});
        const Lanes factor = product(FrictionFactor{normal_force_N_per_m});
        return hn::Tanh(BenchTag(), lanes_of(0.5) * coefficient * factor * wrap_rad);
    }
};

struct LaneTension {
    Lanes value_N, per_m;
};

// The tension of a segment that is stretched by this much beyond its creep (E31, E32). A stiffening cable's
// tension is sought from `last_N`.
HWY_INLINE LaneTension tension_of(const LaneCable& cable, Lanes stretch_m, Lanes last_N) {
    // The stiffness that a slack segment keeps, so that its nodes have a position.
    constexpr double slack_stiffness = 1e-9;
    const Lanes zero = lanes_of(0.0);
    Lanes tension_N = stretch_m * cable.elastic_N_per_m;
    Lanes slope = cable.elastic_N_per_m;
    if (cable.has_toe) {
        const NonlinearStiffnessLaw<Lanes>& law = cable.toe_of_segment;
        const Which toe = hn::And(hn::Gt(law.toe_strain, zero), hn::Gt(stretch_m, zero));
        constexpr int max_refinements = 4;
        constexpr double refined = 1e-6;  // of the tension: the error left is of the order of its square
        // Strain is concave in tension, so Newton from the left of the root stays there. A lane rests once it
        // is refined, whatever the others need.
        Lanes sought_N = hn::Min(hn::Max(last_N, zero), tension_N);
        Lanes per_N = cable.elastic_m_per_N;
        Which open = toe;
        for (int refinement = 0; refinement < max_refinements && !hn::AllFalse(BenchTag(), open);
             ++refinement) {
            const ToeStrain<Lanes> beyond = laws::toe_strain(law, sought_N);
            const Lanes there_m = cable.elastic_m_per_N * sought_N + beyond.strain;
            per_N = hn::IfThenElse(open, cable.elastic_m_per_N + beyond.strain_per_N, per_N);
            const Lanes next_N = hn::Max(zero, sought_N + (stretch_m - there_m) / per_N);
            const Which moves = hn::Gt(hn::Abs(next_N - sought_N), lanes_of(refined) * next_N);
            sought_N = hn::IfThenElse(open, next_N, sought_N);
            open = hn::And(open, moves);
        }
        tension_N = hn::IfThenElse(toe, sought_N, tension_N);
        slope = hn::IfThenElse(toe, lanes_of(1.0) / per_N, slope);
    }
    const Lanes kept = hn::IfThenElse(hn::Gt(stretch_m, zero), lanes_of(1.0), lanes_of(slack_stiffness));
    return {kept * tension_N, kept * slope};
}

}  // namespace capstan::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
