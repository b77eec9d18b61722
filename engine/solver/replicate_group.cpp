// The common way of QuasiStaticStep::advance with a replicate in each lane. The same operations in the same
// order as there, no fused multiply-add: the same bits.
#include "capstan/solver/replicate_group.h"

#include <algorithm>

#include "capstan/solver/cable_end.h"
#include "capstan/solver/chosen_target.h"
#include "capstan/solver/sliding_front.h"
#include "capstan/solver/sliding_run.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/solver/replicate_group.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

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
    const Lanes displacement_share = hn::Mul(end.displacement_factor, h);
    const Lanes change_per_increment = is_proximal ? hn::Sub(displacement_share, end.tension_factor)
                                                   : hn::Add(displacement_share, end.tension_factor);
    return {hn::Gt(hn::Abs(change), hn::Mul(lanes_of(input_rounding), size)),
            hn::Xor(hn::Gt(change, lanes_of(0.0)),
                    which(hn::Lt(hn::BitCast(CountTag(), change_per_increment), count_of(0))))};
}

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

// Nodes that move in all replicates, and in some.
struct Extent {
    int all = 0;
    int some = 0;
};

HWY_INLINE Extent extent_of(Counts moving_nodes) {
    const CountTag d;
    const auto first = hn::GetLane(moving_nodes);
    if (hn::AllTrue(d, hn::Eq(moving_nodes, count_of(first)))) {
        return {static_cast<int>(first), static_cast<int>(first)};
    }
    std::int64_t each[replicates_in_group];
    hn::StoreU(moving_nodes, d, each);
    const auto [fewest, most] = std::minmax_element(each, each + hn::Lanes(d));
    return {static_cast<int>(*fewest), static_cast<int>(*most)};
}

// Calls `use` with the rows of both tables, the cheaper kind if all replicates go the same way.
template <End which_end, class Use>
HWY_INLINE void with_rows(const Group& g, Which forward, Use&& use) {
    const Rows ratio = rows<which_end>(g.group.tables, &SideTable::tension_ratio, forward);
    const Rows elongation = rows<which_end>(g.group.tables, &SideTable::elongation_m_per_N, forward);
    if (all(forward)) {
        use(SameRows{ratio.forward}, SameRows{elongation.forward});
    } else if (!any(forward)) {
        use(SameRows{ratio.backward}, SameRows{elongation.backward});
    } else {
        use(ratio, elongation);
    }
}

template <End which_end>
HWY_INLINE Which every_node_moves(const Group& g, const Side& side, const Extent& extent) {
    const Lanes slope = hn::Mul(lanes_of(CableEnd<which_end>::orientation), side.tension_N);
    const Lanes lowest = lanes_of(-displacement_rounding_m);
    const Lanes turn = hn::IfThenElse(side.forward, lanes_of(0.0), lanes_of(-0.0));
    Lanes least = lowest;
    with_rows<which_end>(g, side.forward, [&](auto, auto elongation) HWY_ATTR {
        const auto increment = [&](int node) HWY_ATTR {
            const Lanes now = hn::Add(side.displacement_m, hn::Mul(slope, elongation.at(node)));
            return hn::Xor(hn::Sub(now, g.displacement(node)), turn);
        };
        int k = 0;
        for (; k < extent.all; ++k) least = hn::Min(least, increment(g.node<which_end>(k)));
        for (; k < extent.some; ++k) {
            const Which in_side = which(hn::Lt(count_of(k), side.moving_nodes));
            least = hn::Min(least, hn::IfThenElse(in_side, increment(g.node<which_end>(k)), lowest));
        }
    });
    return hn::Ge(least, lowest);
}

template <End which_end>
HWY_INLINE void write_nodes(const Group& g, const Side& side, const Extent& extent) {
    const Tag d;
    const Lanes slope = hn::Mul(lanes_of(CableEnd<which_end>::orientation), side.tension_N);
    with_rows<which_end>(g, side.forward, [&](auto ratio, auto elongation) HWY_ATTR {
        int k = 0;
        for (; k < extent.all; ++k) {
            const int node = g.node<which_end>(k);
            hn::StoreU(hn::Mul(side.tension_N, ratio.at(node)), d, g.tension_N(node));
            hn::StoreU(hn::Add(side.displacement_m, hn::Mul(slope, elongation.at(node))), d,
                       g.displacement_m(node));
        }
        for (; k < extent.some; ++k) {
            const int node = g.node<which_end>(k);
            const Which in_side = which(hn::Lt(count_of(k), side.moving_nodes));
            const Lanes tension = hn::Mul(side.tension_N, ratio.at(node));
            const Lanes displacement = hn::Add(side.displacement_m, hn::Mul(slope, elongation.at(node)));
            hn::StoreU(hn::IfThenElse(in_side, tension, g.tension(node)), d, g.tension_N(node));
            hn::StoreU(hn::IfThenElse(in_side, displacement, g.displacement(node)), d,
                       g.displacement_m(node));
        }
    });
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

HWY_INLINE Counts direction_of(const Side& side) {
    return hn::IfThenElseZero(counts(side.moves),
                              hn::IfThenElse(counts(side.forward), count_of(1), count_of(-1)));
}

HWY_INLINE void remember(const Group& g, Which done, Which mass, const Side& proximal, const Side& distal) {
    const CountTag d;
    MotionGroup& motion = g.group.motion;
    const bool all_done = all(done);
    const auto put = [&](Counts now, std::int64_t* group) HWY_ATTR {
        hn::StoreU(all_done ? now : hn::IfThenElse(counts(done), now, hn::LoadU(d, group + g.lane)), d,
                   group + g.lane);
    };
    const auto all_slide = counts(mass);
    const auto rests = hn::Eq(hn::Add(proximal.moving_nodes, distal.moving_nodes), count_of(0));
    const Counts else_kind = hn::IfThenElse(rests, kind_of(MotionKind::rest), kind_of(MotionKind::partial));
    put(hn::IfThenElse(all_slide, kind_of(MotionKind::mass), else_kind), motion.kind);
    put(direction_of(proximal), motion.proximal_direction);
    put(hn::IfThenElse(all_slide, direction_of(proximal), direction_of(distal)), motion.distal_direction);
    put(proximal.moving_nodes, motion.proximal_moving_nodes);
    put(hn::IfThenElse(all_slide, count_of(g.last + 1), distal.moving_nodes), motion.distal_moving_nodes);
    double* fraction = motion.zero_velocity_fraction + g.lane;
    hn::StoreU(hn::IfThenZeroElse(done, hn::LoadU(Tag(), fraction)), Tag(), fraction);
}

HWY_INLINE void only(Which kept, Side& side) {
    side.moves = hn::And(side.moves, kept);
    side.moving_nodes = hn::IfThenElseZero(counts(kept), side.moving_nodes);
}

HWY_INLINE Which advance_lanes(const ReplicateGroup& group, int lane) {
    const Group g{group, lane, group.nodes - 1, motion_before(group.motion, lane)};
    const Line p = line_of(group.proximal, lane);
    const Line d = line_of(group.distal, lane);
    const Ends now = ends_of(group, lane);
    Side proximal = driven_side<End::proximal>(g, p, now);
    Side distal = driven_side<End::distal>(g, d, now);
    if (any(proximal.moves)) find_front<End::proximal>(g, p, proximal);
    if (any(distal.moves)) find_front<End::distal>(g, d, distal);

    const Which meet = which(hn::Gt(hn::Add(proximal.moving_nodes, distal.moving_nodes), count_of(g.last)));
    const Which against =
        hn::And(hn::And(proximal.moves, distal.moves), hn::Xor(proximal.forward, distal.forward));
    const Which mass = hn::AndNot(against, meet);
    Which taut = everybody();
    if (any(mass)) {
        take_mass(g, p, d, mass, proximal, distal);
        taut = hn::Or(hn::Not(mass), hn::Gt(proximal.tension_N, lanes_of(0.0)));
    }
    only(hn::Not(mass), distal);
    Which done = hn::And(hn::AndNot(hn::And(meet, against), taut),
                         hn::Or(mass, hn::And(proximal.holds, distal.holds)));
    only(done, proximal);
    only(done, distal);
    Extent near = extent_of(proximal.moving_nodes);
    Extent far = any(distal.moves) ? extent_of(distal.moving_nodes) : Extent{};
    Which moves = every_node_moves<End::proximal>(g, proximal, near);
    if (far.some > 0) moves = hn::And(moves, every_node_moves<End::distal>(g, distal, far));
    if (any(hn::AndNot(moves, done))) {
        done = hn::And(done, moves);
        only(done, proximal);
        only(done, distal);
        near = extent_of(proximal.moving_nodes);
        far = extent_of(distal.moving_nodes);
    }
    write_nodes<End::proximal>(g, proximal, near);
    if (far.some > 0) write_nodes<End::distal>(g, distal, far);
    pin(group, p, 0, lane, proximal.moves);
    pin(group, d, g.last, lane, hn::Or(distal.moves, hn::And(done, mass)));
    remember(g, done, mass, proximal, distal);
    return done;
}

// The whole group was in mass motion one way and goes on: no replicate needs to be told apart from the
// others, and the motion is remembered already. False, and nothing has changed, if that is not so.
template <Direction direction>
HWY_INLINE bool mass_goes_on(const ReplicateGroup& group) {
    const Tag d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
    constexpr int vectors = replicates_in_group / lanes;
    const int last = group.nodes - 1;
    const SideTable& table = group.tables.proximal(sign(direction));
    const double* HWY_RESTRICT ratio = table.tension_ratio.data();
    const double* HWY_RESTRICT elongation = table.elongation_m_per_N.data();
    const auto against = [](const Driven& end) HWY_ATTR {
        return direction == Direction::forward ? hn::AndNot(end.forward, end.moves)
                                               : hn::And(end.forward, end.moves);
    };
    Lanes tension[vectors];
    Lanes displacement[vectors];
    Which good = everybody();
    for (int v = 0; v < vectors; ++v) {
        const Line p = line_of(group.proximal, v * lanes);
        const Line q = line_of(group.distal, v * lanes);
        const Ends now = ends_of(group, v * lanes);
        const Driven proximal = driven<End::proximal>(group.tables, p, now);
        const Driven distal = driven<End::distal>(group.tables, q, now);
        const EndLanes values = mass_motion(p, q, lanes_of(ratio[last]), lanes_of(elongation[last]));
        tension[v] = values.tension_N;
        displacement[v] = values.displacement_m;
        const Which on =
            hn::AndNot(hn::Or(against(proximal), against(distal)), hn::Or(proximal.moves, distal.moves));
        good = hn::And(good, hn::And(on, hn::Gt(values.tension_N, lanes_of(0.0))));
    }
    if (!all(good)) return false;

    const Lanes lowest = lanes_of(-displacement_rounding_m);
    Lanes least = lowest;
    const double* HWY_RESTRICT before_m = group.displacement_m;
    for (int node = 0; node <= last; ++node, before_m += replicates_in_group) {
        const Lanes stretch = lanes_of(elongation[node]);
        for (int v = 0; v < vectors; ++v) {
            const Lanes now = hn::Add(displacement[v], hn::Mul(tension[v], stretch));
            const Lanes before = hn::LoadU(d, before_m + v * lanes);
            least =
                hn::Min(least, direction == Direction::forward ? hn::Sub(now, before) : hn::Sub(before, now));
        }
    }
    if (!all(hn::Ge(least, lowest))) return false;

    double* HWY_RESTRICT tension_N = group.tension_N;
    double* HWY_RESTRICT displacement_m = group.displacement_m;
    for (int node = 0; node <= last; ++node) {
        const Lanes pull = lanes_of(ratio[node]);
        const Lanes stretch = lanes_of(elongation[node]);
        for (int v = 0; v < vectors; ++v) {
            hn::StoreU(hn::Mul(tension[v], pull), d, tension_N + v * lanes);
            hn::StoreU(hn::Add(displacement[v], hn::Mul(tension[v], stretch)), d, displacement_m + v * lanes);
        }
        tension_N += replicates_in_group;
        displacement_m += replicates_in_group;
    }
    for (int lane = 0; lane < replicates_in_group; lane += lanes) {
        pin(group, line_of(group.proximal, lane), 0, lane, everybody());
        pin(group, line_of(group.distal, lane), last, lane, everybody());
    }
    return true;
}

// The direction in which the whole group was in mass motion.
HWY_INLINE Direction mass_before(const ReplicateGroup& group) {
    const CountTag d;
    const MotionGroup& motion = group.motion;
    const Counts mass = kind_of(MotionKind::mass);
    const Counts direction = count_of(motion.proximal_direction[0]);
    const Counts nodes = count_of(group.nodes);
    auto same = hn::Eq(mass, mass);
    for (int lane = 0; lane < replicates_in_group; lane += static_cast<int>(hn::Lanes(d))) {
        const auto is = [&](const std::int64_t* of, Counts value)
                            HWY_ATTR { same = hn::And(same, hn::Eq(hn::LoadU(d, of + lane), value)); };
        is(motion.kind, mass);
        is(motion.proximal_direction, direction);
        is(motion.distal_direction, direction);
        is(motion.proximal_moving_nodes, nodes);
        is(motion.distal_moving_nodes, nodes);
    }
    return hn::AllTrue(d, same) ? static_cast<Direction>(motion.proximal_direction[0]) : Direction::none;
}

HWY_INLINE ReplicateBits bits_of(Which mask, int lane) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Tag(), mask, bits);
    return static_cast<ReplicateBits>(bits[0]) << lane;
}

ReplicateBits advance_all(const ReplicateGroup& group) {
    const Direction mass = mass_before(group);
    if ((mass == Direction::forward && mass_goes_on<Direction::forward>(group)) ||
        (mass == Direction::backward && mass_goes_on<Direction::backward>(group))) {
        return (1u << replicates_in_group) - 1u;
    }
    ReplicateBits done = 0;
    const int step = static_cast<int>(hn::Lanes(Tag()));
    for (int lane = 0; lane < replicates_in_group; lane += step)
        done |= bits_of(advance_lanes(group, lane), lane);
    return done;
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(advance_all);

ReplicateBits advance_group(const ReplicateGroup& group) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(advance_all); });
    return chosen(group);
}

}  // namespace capstan
#endif
