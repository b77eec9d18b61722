// The common way of QuasiStaticStep::advance with a replicate in each lane. The same operations in the same
// order as there, no fused multiply-add: the same bits.
#include "capstan/solver/replicate_group.h"

#include "capstan/solver/chosen_target.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/solver/replicate_group.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "capstan/solver/replicate_motions-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
        good = hn::And(good, is_finite(values.tension_N, values.displacement_m));
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
