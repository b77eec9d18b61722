// A step of a vector of replicates, each in a motion of its own: rest, partial or mass.
// Compiled once for each instruction set: Highway's guard instead of pragma once.
#if defined(CAPSTAN_SOLVER_REPLICATE_MOTIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef CAPSTAN_SOLVER_REPLICATE_MOTIONS_INL_H
#undef CAPSTAN_SOLVER_REPLICATE_MOTIONS_INL_H
#else
#define CAPSTAN_SOLVER_REPLICATE_MOTIONS_INL_H
#endif

#include <algorithm>

#include "capstan/solver/replicate_sides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
    const Which hangs = hn::AndNot(hn::Or(proximal.moves, distal.moves), g.before.slack);
    const auto numbers = [](const Side& side) HWY_ATTR {
        return hn::Or(hn::Not(side.moves), is_finite(side.tension_N, side.displacement_m));
    };
    done = hn::AndNot(hangs, hn::And(done, hn::And(numbers(proximal), numbers(distal))));
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

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
