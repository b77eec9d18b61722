// Where the fronts of each replicate are (sliding_front.h), each lane on its own.
// Compiled once for each instruction set: Highway's guard instead of pragma once.
#if defined(CAPSTAN_SOLVER_REPLICATE_SIDES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_SOLVER_REPLICATE_SIDES_INL_H
#undef CAPSTAN_SOLVER_REPLICATE_SIDES_INL_H
#else
#define CAPSTAN_SOLVER_REPLICATE_SIDES_INL_H
#endif

#include "capstan/solver/replicate_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A side of each replicate.
struct Side {
    Which moves;
    Which forward;
    Counts moving_nodes;
    Lanes tension_N;       // of the end
    Lanes displacement_m;  // of the end
    Which holds;           // the resting node next to the front
};

struct Group {
    const ReplicateGroup& group;
    int lane;  // first one
    int last;  // node
    Before before;

    template <End which_end>
    HWY_INLINE int node(int k) const {
        return which_end == End::proximal ? k : last - k;
    }

    HWY_INLINE double* tension_N(int node) const {
        return group.tension_N + node * replicates_in_group + lane;
    }
    HWY_INLINE double* displacement_m(int node) const {
        return group.displacement_m + node * replicates_in_group + lane;
    }
    HWY_INLINE Lanes tension(int node) const { return hn::LoadU(Tag(), tension_N(node)); }
    HWY_INLINE Lanes displacement(int node) const { return hn::LoadU(Tag(), displacement_m(node)); }

    // Index of a node of each replicate, from its first lane.
    HWY_INLINE Counts place(Counts node) const {
        static_assert(replicates_in_group == 8);
        return hn::Add(hn::ShiftLeft<3>(node), hn::Iota(CountTag(), 0));
    }

    // StepView::holding_ratio.
    HWY_INLINE Lanes holding_ratio(Counts segment) const {
        const Tag d;
        const Lanes breakaway = hn::GatherIndex(d, group.tables.breakaway_ratio.data(), segment);
        if (group.stiction == StictionRule::memoryless) return breakaway;
        const auto proximal = hn::Lt(hn::Add(segment, count_of(1)), before.proximal_nodes);
        const auto distal = hn::Gt(segment, hn::Sub(count_of(last), before.distal_nodes));
        const auto zero = count_of(0);
        const auto slid =
            hn::Or(hn::And(proximal, hn::Ne(before.proximal_direction, zero)),
                   hn::And(hn::AndNot(proximal, distal), hn::Ne(before.distal_direction, zero)));
        const Which memory = hn::AndNot(before.slack, which(slid));
        if (!any(memory)) return breakaway;
        return hn::IfThenElse(memory, hn::GatherIndex(d, group.tables.sliding_ratio.data(), segment),
                              breakaway);
    }
};

template <End which_end>
HWY_INLINE Side driven_side(const Group& g, const Line& end, const Ends& now) {
    const auto [moves, forward] = driven<which_end>(g.group.tables, end, now);
    const Counts before_direction =
        which_end == End::proximal ? g.before.proximal_direction : g.before.distal_direction;
    const Counts before_nodes = which_end == End::proximal ? g.before.proximal_nodes : g.before.distal_nodes;
    const Counts direction = hn::IfThenElse(counts(forward), count_of(1), count_of(-1));
    const Counts nodes = count_of(g.last + 1);
    const Counts remembered = hn::IfThenElse(
        counts(g.before.slack), nodes, hn::IfThenElseZero(hn::Eq(before_direction, direction), before_nodes));
    const Counts first = hn::IfThenElse(hn::Eq(remembered, count_of(0)), count_of(1), remembered);
    return {moves,         forward,       hn::IfThenElseZero(counts(moves), first),
            lanes_of(0.0), lanes_of(0.0), everybody()};
}

// sliding_front.h: the front goes on, in each replicate by itself, until its resting neighbour holds.
template <End which_end>
HWY_INLINE void find_front(const Group& g, const Line& end, Side& side) {
    constexpr double orientation = CableEnd<which_end>::orientation;
    const Tag d;
    const Counts nodes = count_of(g.last + 1);
    const Rows ratio = rows<which_end>(g.group.tables, &SideTable::tension_ratio, side.forward);
    const Rows compliance =
        rows<which_end>(g.group.tables, &SideTable::front_compliance_m_per_N, side.forward);
    const Lanes h = lanes_of(orientation * g.group.tables.half_compliance_m_per_N);
    const Which outward = which_end == End::proximal ? side.forward : hn::Not(side.forward);
    Which searching = hn::And(side.moves, which(hn::Lt(side.moving_nodes, nodes)));
    while (any(searching)) {
        // Whoever is done looks at the first node, and nobody minds.
        const Counts k = hn::IfThenElse(counts(searching), side.moving_nodes, count_of(1));
        const Counts moving = which_end == End::proximal ? hn::Sub(k, count_of(1)) : hn::Sub(nodes, k);
        const Counts resting = which_end == End::proximal ? k : hn::Sub(moving, count_of(1));
        const Counts segment = which_end == End::proximal ? moving : resting;
        const Lanes resting_tension = hn::GatherIndex(d, g.tension_N(0), g.place(resting));
        const Lanes anchor =
            hn::Sub(hn::GatherIndex(d, g.displacement_m(0), g.place(resting)), hn::Mul(h, resting_tension));
        const Lanes front_compliance = compliance.gather(moving);
        const Lanes tension = hn::Div(
            hn::Sub(end.value, hn::Mul(end.displacement_factor, anchor)),
            hn::Sub(end.tension_factor,
                    hn::Mul(hn::Mul(lanes_of(orientation), end.displacement_factor), front_compliance)));
        const Lanes moving_tension = hn::Mul(tension, ratio.gather(moving));
        const Lanes hold = g.holding_ratio(segment);
        const Which pulled = hn::Ge(resting_tension, hn::Mul(moving_tension, hold));
        const Which pulls = hn::Ge(moving_tension, hn::Mul(resting_tension, hold));
        const Which gives = hn::Or(hn::And(outward, pulled), hn::AndNot(outward, pulls));

        const Which found = hn::AndNot(gives, searching);
        const Lanes cone = hn::Mul(hold, lanes_of(1.0 + tension_rounding));
        const Which holds = hn::And(hn::Le(moving_tension, hn::Mul(resting_tension, cone)),
                                    hn::Le(resting_tension, hn::Mul(moving_tension, cone)));
        side.holds = hn::Or(hn::And(found, holds), hn::AndNot(found, side.holds));
        side.tension_N = hn::IfThenElse(found, tension, side.tension_N);
        side.displacement_m = hn::IfThenElse(
            found, hn::Sub(anchor, hn::Mul(hn::Mul(lanes_of(orientation), front_compliance), tension)),
            side.displacement_m);
        searching = hn::And(searching, gives);
        side.moving_nodes = hn::Add(side.moving_nodes, hn::IfThenElseZero(counts(searching), count_of(1)));
        searching = hn::And(searching, which(hn::Lt(side.moving_nodes, nodes)));
    }
}

// Replicates `mass` get the whole cable in motion as their proximal side.
HWY_INLINE void take_mass(const Group& g, const Line& p, const Line& d, Which mass, Side& proximal,
                          const Side& distal) {
    const Which forward =
        hn::Or(hn::And(proximal.moves, proximal.forward), hn::AndNot(proximal.moves, distal.forward));
    const EndLanes values =
        mass_motion(p, d, rows<End::proximal>(g.group.tables, &SideTable::tension_ratio, forward).at(g.last),
                    rows<End::proximal>(g.group.tables, &SideTable::elongation_m_per_N, forward).at(g.last));
    proximal.moves = hn::Or(proximal.moves, mass);
    proximal.forward = hn::Or(hn::And(mass, forward), hn::AndNot(mass, proximal.forward));
    proximal.moving_nodes = hn::IfThenElse(counts(mass), count_of(g.last + 1), proximal.moving_nodes);
    proximal.tension_N = hn::IfThenElse(mass, values.tension_N, proximal.tension_N);
    proximal.displacement_m = hn::IfThenElse(mass, values.displacement_m, proximal.displacement_m);
}

HWY_INLINE void only(Which kept, Side& side) {
    side.moves = hn::And(side.moves, kept);
    side.moving_nodes = hn::IfThenElseZero(counts(kept), side.moving_nodes);
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
