// The formulas of the step with a replicate in each lane.
// Compiled once for each instruction set: Highway's guard instead of pragma once.
#if defined(CAPSTAN_SOLVER_REPLICATE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_SOLVER_REPLICATE_LANES_INL_H
#undef CAPSTAN_SOLVER_REPLICATE_LANES_INL_H
#else
#define CAPSTAN_SOLVER_REPLICATE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "capstan/solver/replicate_group.h"
#include "capstan/solver/sliding_front.h"
#include "capstan/solver/sliding_run.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, replicates_in_group>;
using CountTag = hn::RebindToSigned<Tag>;
using Lanes = hn::Vec<Tag>;
using Counts = hn::Vec<CountTag>;
using Which = hn::Mask<Tag>;

HWY_INLINE Counts count_of(std::int64_t count) {
    return hn::Set(CountTag(), count);
}
HWY_INLINE Lanes lanes_of(double value) {
    return hn::Set(Tag(), value);
}
HWY_INLINE Which which(hn::Mask<CountTag> mask) {
    return hn::RebindMask(Tag(), mask);
}
HWY_INLINE hn::Mask<CountTag> counts(Which mask) {
    return hn::RebindMask(CountTag(), mask);
}
HWY_INLINE Which nobody() {
    return hn::Lt(lanes_of(0.0), lanes_of(0.0));
}
HWY_INLINE Which everybody() {
    return hn::Eq(lanes_of(0.0), lanes_of(0.0));
}
HWY_INLINE bool any(Which mask) {
    return !hn::AllFalse(Tag(), mask);
}
HWY_INLINE bool all(Which mask) {
    return hn::AllTrue(Tag(), mask);
}

// is_finite of candidate.h.
HWY_INLINE Which is_finite(Lanes tension_N, Lanes displacement_m) {
    const Lanes largest = lanes_of(largest_number);
    return hn::And(hn::Le(hn::Abs(tension_N), largest), hn::Le(hn::Abs(displacement_m), largest));
}

// A condition at one end.
struct Line {
    Lanes displacement_factor;
    Lanes tension_factor;
    Lanes value;
};

HWY_INLINE Line line_of(const EndGroup& end, int lane) {
    const Tag d;
    return {hn::LoadU(d, end.displacement_factor + lane), hn::LoadU(d, end.tension_factor + lane),
            hn::LoadU(d, end.value + lane)};
}

// Motion before the step.
struct Before {
    Counts proximal_direction, distal_direction;
    Counts proximal_nodes, distal_nodes;
    Which slack;
};

HWY_INLINE Before motion_before(const MotionGroup& motion, int lane) {
    const CountTag d;
    return {hn::LoadU(d, motion.proximal_direction + lane), hn::LoadU(d, motion.distal_direction + lane),
            hn::LoadU(d, motion.proximal_moving_nodes + lane),
            hn::LoadU(d, motion.distal_moving_nodes + lane),
            which(hn::Eq(hn::LoadU(d, motion.kind + lane),
                         count_of(static_cast<std::int64_t>(MotionKind::slack))))};
}

// A table of which each replicate uses the one for its direction.
struct Rows {
    const double* forward;
    const double* backward;
    Which is_forward;

    HWY_INLINE Lanes at(int node) const {
        return hn::IfThenElse(is_forward, lanes_of(forward[node]), lanes_of(backward[node]));
    }
    HWY_INLINE Lanes gather(Counts node) const {
        const Tag d;
        if (all(is_forward)) return hn::GatherIndex(d, forward, node);
        const Lanes back = hn::GatherIndex(d, backward, node);
        return any(is_forward) ? hn::IfThenElse(is_forward, hn::GatherIndex(d, forward, node), back) : back;
    }
};
// All replicates use the same one.
struct SameRows {
    const double* table;
    HWY_INLINE Lanes at(int node) const { return lanes_of(table[node]); }
};

template <End which_end>
HWY_INLINE const SideTable& side_table(const PrefixTables& tables, int direction_sign) {
    return which_end == End::proximal ? tables.proximal(direction_sign) : tables.distal(direction_sign);
}
template <End which_end>
HWY_INLINE Rows rows(const PrefixTables& tables, NodeTable SideTable::*table, Which is_forward) {
    return {(side_table<which_end>(tables, 1).*table).data(),
            (side_table<which_end>(tables, -1).*table).data(), is_forward};
}

// Both ends of each replicate before the step.
struct Ends {
    Lanes proximal_tension, proximal_displacement;
    Lanes distal_tension, distal_displacement;
};

HWY_INLINE Ends ends_of(const ReplicateGroup& group, int lane) {
    const Tag d;
    const int last = (group.nodes - 1) * replicates_in_group + lane;
    return {hn::LoadU(d, group.tension_N + lane), hn::LoadU(d, group.displacement_m + lane),
            hn::LoadU(d, group.tension_N + last), hn::LoadU(d, group.displacement_m + last)};
}

// Which replicates an end drives, and which way.
struct Driven {
    Which moves;
    Which forward;
};

// driven_direction of sliding_front.h.
template <End which_end>
HWY_INLINE Driven driven(const PrefixTables& tables, const Line& end, const Ends& now) {
    constexpr bool is_proximal = which_end == End::proximal;
    const Lanes scale_m = hn::Add(hn::Abs(now.proximal_displacement), hn::Abs(now.distal_displacement));
    const Lanes tension_part =
        hn::Mul(end.tension_factor, is_proximal ? now.proximal_tension : now.distal_tension);
    const Lanes displacement_part =
        hn::Mul(end.displacement_factor, is_proximal ? now.proximal_displacement : now.distal_displacement);
    const Lanes change = hn::Sub(end.value, hn::Add(displacement_part, tension_part));
    const Lanes size =
        hn::Add(hn::Add(hn::Mul(hn::Abs(end.displacement_factor), scale_m), hn::Abs(tension_part)),
                hn::Abs(end.value));
    const Lanes h = lanes_of(tables.half_compliance_m_per_N);
    const Lanes displacement_fraction = hn::Mul(end.displacement_factor, h);
    const Lanes change_per_increment = is_proximal ? hn::Sub(displacement_fraction, end.tension_factor)
                                                   : hn::Add(displacement_fraction, end.tension_factor);
    return {hn::Gt(hn::Abs(change), hn::Mul(lanes_of(input_rounding), size)),
            hn::Xor(hn::Gt(change, lanes_of(0.0)),
                    which(hn::Lt(hn::BitCast(CountTag(), change_per_increment), count_of(0))))};
}

// Tension and displacement of the proximal end.
struct EndLanes {
    Lanes tension_N;
    Lanes displacement_m;
};

// proximal_values of candidate.h.
HWY_INLINE EndLanes mass_motion(const Line& p, const Line& d, Lanes ratio, Lanes elongation) {
    const Lanes distal_factor =
        hn::Add(hn::Mul(d.displacement_factor, elongation), hn::Mul(d.tension_factor, ratio));
    const Lanes determinant = hn::Sub(hn::Mul(p.displacement_factor, distal_factor),
                                      hn::Mul(p.tension_factor, d.displacement_factor));
    return {
        hn::Div(hn::Sub(hn::Mul(p.displacement_factor, d.value), hn::Mul(d.displacement_factor, p.value)),
                determinant),
        hn::Div(hn::Sub(hn::Mul(p.value, distal_factor), hn::Mul(p.tension_factor, d.value)), determinant)};
}

// pin_ends of candidate.h.
HWY_INLINE void pin(const ReplicateGroup& group, const Line& end, int node, int lane, Which moves) {
    const Tag d;
    const auto put = [&](Which pinned, Lanes factor, double* nodes) HWY_ATTR {
        if (!any(pinned)) return;
        double* at = nodes + node * replicates_in_group + lane;
        hn::StoreU(hn::IfThenElse(pinned, hn::Div(end.value, factor), hn::LoadU(d, at)), d, at);
    };
    put(hn::And(moves, hn::Eq(end.tension_factor, lanes_of(0.0))), end.displacement_factor,
        group.displacement_m);
    put(hn::And(moves, hn::Eq(end.displacement_factor, lanes_of(0.0))), end.tension_factor, group.tension_N);
}

HWY_INLINE Counts kind_of(MotionKind kind) {
    return count_of(static_cast<std::int64_t>(kind));
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
