// The laws of engine/effects with a bench in each lane.
// Compiled once for each instruction set: Highway's guard instead of pragma once.
#if defined(CAPSTAN_SOLVER_BENCH_LAWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_SOLVER_BENCH_LAWS_INL_H
#undef CAPSTAN_SOLVER_BENCH_LAWS_INL_H
#else
#define CAPSTAN_SOLVER_BENCH_LAWS_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

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

struct Laws {
    HWY_INLINE Laws(const CableLaws& laws, int lane)
        : of(&laws),
          stretch_m_per_N(load(laws.stretch_m_per_N, lane)),
          creep_fraction(load(laws.creep_fraction, lane)),
          creep_stays(lanes_of(1.0) - creep_fraction),
          creep_m_per_N(load(laws.creep_m_per_N, lane)),
          elastic_m_per_N(stretch_m_per_N + creep_fraction * creep_m_per_N),
          elastic_N_per_m(lanes_of(1.0) / elastic_m_per_N),
          toe_m(load(laws.toe_m, lane)),
          toe_tension_N(load(laws.toe_tension_N, lane)),
          bristle_m(load(laws.bristle_m, lane)),
          bristle_per_m(lanes_of(1.0) / bristle_m),
          bristle_exponent(load(laws.bristle_exponent, lane)),
          rigid_N_per_m(load(laws.rigid_N_per_m, lane)),
          viscous_N_per_m2(load(laws.viscous_N_per_m2, lane)),
          dynamic_friction(load(laws.dynamic_friction, lane)),
          stribeck_friction(load(laws.stribeck_friction, lane)),
          stribeck_speed_m_per_s(load(laws.stribeck_speed_m_per_s, lane)),
          stribeck_fraction(load(laws.stribeck_fraction, lane)),
          load_exponent(load(laws.load_exponent, lane)),
          load_reference_N_per_m(load(laws.load_reference_N_per_m, lane)),
          varies(hn::Ne(load(laws.varying_friction, lane), lanes_of(0.0))) {}

    const CableLaws* of;
    Lanes stretch_m_per_N, creep_fraction, creep_stays, creep_m_per_N, elastic_m_per_N, elastic_N_per_m,
        toe_m, toe_tension_N, bristle_m, bristle_per_m, bristle_exponent, rigid_N_per_m, viscous_N_per_m2,
        dynamic_friction, stribeck_friction, stribeck_speed_m_per_s, stribeck_fraction, load_exponent,
        load_reference_N_per_m;
    Which varies;
};

struct LaneTension {
    Lanes value_N, per_m;
};

// What a slack segment keeps of its stiffness, so that its nodes stay somewhere.
constexpr double slack_stiffness = 1e-9;

// Of a segment that is stretched by this much beyond its creep (E31, E32); `last_N`: where a stiffening
// cable's tension is sought from.
HWY_INLINE LaneTension tension_of(const Laws& laws, Lanes stretch_m, Lanes last_N) {
    const BenchTag d;
    const Lanes zero = lanes_of(0.0);
    Lanes tension_N = stretch_m * laws.elastic_N_per_m;
    Lanes slope = laws.elastic_N_per_m;
    if (laws.of->any_toe) {
        const Which toe = hn::And(hn::Gt(laws.toe_m, zero), hn::Gt(stretch_m, zero));
        // Strain is concave in tension, so Newton from the left of the root stays there.
        Lanes sought_N = hn::Min(hn::Max(last_N, zero), tension_N);
        Lanes per_N = laws.elastic_m_per_N;
        for (int refinement = 0; refinement < 4; ++refinement) {
            const Lanes faded = hn::Exp(d, hn::Neg(sought_N) / laws.toe_tension_N);
            const Lanes there_m = laws.elastic_m_per_N * sought_N + laws.toe_m * (lanes_of(1.0) - faded);
            per_N = laws.elastic_m_per_N + laws.toe_m / laws.toe_tension_N * faded;
            sought_N = hn::Max(zero, sought_N + (stretch_m - there_m) / per_N);
        }
        tension_N = hn::IfThenElse(toe, sought_N, tension_N);
        slope = hn::IfThenElse(toe, lanes_of(1.0) / per_N, slope);
    }
    const Lanes kept = hn::IfThenElse(hn::Gt(stretch_m, zero), lanes_of(1.0), lanes_of(slack_stiffness));
    return {kept * tension_N, kept * slope};
}

struct LaneBristle {
    Lanes bend, bend_per_m;
};

// E22, see Presliding.
HWY_INLINE LaneBristle bristle_after(const Laws& laws, Lanes bend, Lanes slid_m) {
    const BenchTag d;
    const Lanes zero = lanes_of(0.0);
    const Lanes one = lanes_of(1.0);
    const Lanes leaning = hn::IfThenElse(hn::Eq(slid_m, zero), bend, slid_m);
    const Lanes way = hn::IfThenElse(hn::Lt(leaning, zero), lanes_of(-1.0), one);
    const Lanes gap = one - way * bend;  // to full friction this way
    const Lanes path = hn::Abs(slid_m) * laws.bristle_per_m;
    const Which builds = hn::Gt(gap, path);
    LaneBristle after = {hn::IfThenElse(builds, bend + slid_m * laws.bristle_per_m, way),
                         hn::IfThenElseZero(builds, laws.bristle_per_m)};
    if (!laws.of->any_bristle_exponent) return after;
    const Which straight = hn::Eq(laws.bristle_exponent, zero);
    const Which exponential = hn::Eq(laws.bristle_exponent, one);
    // gap^(1 - n) falls linearly along the path; for n = 1 its logarithm does.
    const Lanes power = hn::IfThenElse(exponential, one, one - laws.bristle_exponent);
    const Lanes tiny = lanes_of(1e-300);
    const Lanes log_gap = hn::Log(d, hn::Max(gap, tiny));
    const Lanes left_power = hn::Exp(d, power * log_gap) - power * path;
    const Lanes log_left =
        hn::IfThenElse(exponential, log_gap - path, hn::Log(d, hn::Max(left_power, tiny)) / power);
    const Which none_left = hn::Or(hn::Le(gap, zero), hn::AndNot(exponential, hn::Le(left_power, zero)));
    const Lanes left = hn::IfThenElse(none_left, zero, hn::Exp(d, log_left));
    const Lanes slope =
        hn::IfThenElse(none_left, zero, hn::Exp(d, laws.bristle_exponent * log_left) * laws.bristle_per_m);
    after.bend = hn::IfThenElse(straight, after.bend, way * (one - left));
    after.bend_per_m = hn::IfThenElse(straight, after.bend_per_m, slope);
    return after;
}

// tanh(mu theta / 2) with the coefficient of E21 and E23.
HWY_INLINE Lanes friction_of(const Laws& laws, Lanes wrap_rad, Lanes lagging_speed, Lanes force_N_per_m) {
    const BenchTag d;
    const Lanes one = lanes_of(1.0);
    const Lanes ratio = lagging_speed / laws.stribeck_speed_m_per_s;
    const Lanes coefficient =
        laws.dynamic_friction + laws.stribeck_friction * hn::Exp(d, hn::Neg(ratio * ratio));
    constexpr double least = 0.05;  // of the reference, see LoadDependentFriction
    constexpr double most = 20.0;
    const Lanes held =
        hn::Min(lanes_of(most), hn::Max(lanes_of(least), force_N_per_m / laws.load_reference_N_per_m));
    const Lanes factor = hn::Exp(d, (laws.load_exponent - one) * hn::Log(d, held));
    return hn::Tanh(d, lanes_of(0.5) * coefficient * factor * wrap_rad);
}

}  // namespace capstan::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
