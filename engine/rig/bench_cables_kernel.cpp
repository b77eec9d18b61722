// A bench in each lane. There is no fused multiply-add, and a lane never depends on its neighbours.
#include "capstan/rig/bench_cables_kernel.h"

#include "capstan/solver/chosen_target.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/rig/bench_cables_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "capstan/rig/lane_laws-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::bench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Lanes>
HWY_INLINE Lanes moved_m(const CableLanes& cable, int node, int lane) {
    return load<Lanes>(cable.displacement_m[node], lane) - load<Lanes>(cable.before_m[node], lane);
}

// How far the last half segment has slid in this step: its middle moves with the load's end, and by a part of
// what the neighbour moves beyond that.
template <class Lanes>
HWY_INLINE Lanes slid_at_load_m(const CableLanes& cable, int last, Lanes of_neighbour, int lane) {
    return (lanes_of<Lanes>(1.0) - of_neighbour) * moved_m<Lanes>(cable, last, lane) +
           of_neighbour * moved_m<Lanes>(cable, last - 1, lane);
}

// A node, and a segment, in the present guess. Its tension follows strain + loss * rate of strain (E72,
// implicit Euler).
template <class Lanes>
struct NodeGuess {
    Lanes friction, bend, bend_per_m, slid_m;
    Lanes dragged_m;  // 2/3 of the speed at the end of the step, times the step (E20)
};
template <class Lanes>
HWY_INLINE NodeGuess<Lanes> node_guess(const CableLanes& cable, const LaneCable<Lanes>& mechanics, int node,
                                       Lanes slid_m, int lane) {
    const PreslidingLaw<Lanes>& presliding = mechanics;
    const Bristle<Lanes> bristle =
        laws::bristle_after(presliding, load<Lanes>(cable.before_bend[node], lane), slid_m);
    store(bristle.bend, cable.bend[node], lane);
    const Lanes dragged_m = mechanics.drags ? slid_m - load<Lanes>(cable.before_speed_m_per_s[node], lane) *
                                                           mechanics.time_step_s * lanes_of<Lanes>(1.0 / 3.0)
                                            : slid_m;
    return {load<Lanes>(cable.friction[node], lane), bristle.bend, bristle.bend_per_m, slid_m, dragged_m};
}

template <class Lanes, int cables>
HWY_INLINE void guess_segments(const CablesGroup& group, const LaneCable<Lanes>& mechanics,
                               Which<Lanes> active, int segment, int lane,
                               LaneTension<Lanes> (&guess)[cables]) {
    Lanes strained_m[cables], last_N[cables];
    const Lanes settled_m = load<Lanes>(group.settled_m, lane);
    for (int c = 0; c < cables; ++c) {
        const CableLanes& cable = group.cable[c];
        const Lanes crept_m = mechanics.creeps
                                  ? load<Lanes>(cable.crept_m[segment], lane) * mechanics.creep_stays
                                  : lanes_of<Lanes>(0.0);
        const Lanes stretch_m = load<Lanes>(cable.displacement_m[segment + 1], lane) -
                                load<Lanes>(cable.displacement_m[segment], lane);
        const Lanes before_m =
            load<Lanes>(cable.before_m[segment + 1], lane) - load<Lanes>(cable.before_m[segment], lane);
        strained_m[c] = stretch_m - crept_m - settled_m + mechanics.loss_steps * (stretch_m - before_m);
        last_N[c] = load<Lanes>(cable.tension_N[segment], lane);
    }
    find_tensions(mechanics, strained_m, last_N, guess);
    const Lanes per_stretch = lanes_of<Lanes>(1.0) + mechanics.loss_steps;
    for (int c = 0; c < cables; ++c) {
        guess[c].per_m = guess[c].per_m * per_stretch;
        store(hn::IfThenElse(active, guess[c].value_N, last_N[c]), group.cable[c].tension_N[segment], lane);
    }
}

// A tension beyond an end node's half segment, and how it goes with that node and its neighbour.
template <class Lanes>
struct InnerEnd {
    Lanes value_N, per_end_m, per_inner_m;
};

// `way` -1 at the motor end, 1 at the load end: T = t (1 + way q) / (1 - way q) + way (drags), q = z tanh(mu
// theta / 2).
template <class Lanes>
HWY_INLINE InnerEnd<Lanes> inner_end(const LaneCable<Lanes>& mechanics, const NodeGuess<Lanes>& node,
                                     const LaneTension<Lanes>& segment, double way_value, double span_m,
                                     Lanes of_neighbour) {
    const Lanes one = lanes_of<Lanes>(1.0);
    const Lanes way = lanes_of<Lanes>(way_value);
    const Lanes pressing_N = hn::Max(lanes_of<Lanes>(0.0), segment.value_N);
    const Lanes q =
        way * hn::IfThenElseZero(hn::Gt(pressing_N, lanes_of<Lanes>(0.0)), node.friction * node.bend);
    const Lanes grown = (one + q) / (one - q);
    const Lanes rigid_N =
        hn::IfThenElseZero(hn::Gt(pressing_N, lanes_of<Lanes>(0.0)), mechanics.constant_drag_N(span_m));
    const Lanes viscous_N_per_m = mechanics.sliding_drag_N_per_m(span_m);
    const Lanes by_bend_N =
        lanes_of<Lanes>(2.0) * node.friction * pressing_N / ((one - q) * (one - q)) + rigid_N;
    const Lanes stiffness = segment.per_m * grown;
    const Lanes by_bristles = by_bend_N * node.bend_per_m;
    const Lanes of_end = one - of_neighbour;
    return {segment.value_N * grown + way * (rigid_N * node.bend + viscous_N_per_m * node.dragged_m),
            way * (stiffness + of_end * by_bristles + of_end * viscous_N_per_m),
            way * (of_neighbour * (by_bristles + viscous_N_per_m) - stiffness)};
}

template <class Lanes, int cables>
HWY_INLINE void linearise_lanes(const CablesGroup& group, Which<Lanes> active, int lane,
                                const EndPlaces* motor, const EndPlaces* load_end, EndTensions* at_motor,
                                EndTensions* at_load) {
    const LaneCable<Lanes> mechanics(group, lane);
    const int last = group.nodes - 1;
    const double half_m = 0.5 * group.segment_m;
    const Lanes one = lanes_of<Lanes>(1.0);
    const Lanes zero = lanes_of<Lanes>(0.0);
    LaneTension<Lanes> before[cables];
    LaneTension<Lanes> behind[cables];
    InnerEnd<Lanes> inner_motor[cables];
    Lanes upper[cables], value[cables], by_motor[cables];

    // Motor end: u_0 = at + per_rad turn + compliance T.
    guess_segments(group, mechanics, active, 0, lane, before);
    for (int c = 0; c < cables; ++c) {
        const CableLanes& cable = group.cable[c];
        const NodeGuess<Lanes> end = node_guess(cable, mechanics, 0, moved_m<Lanes>(cable, 0, lane), lane);
        inner_motor[c] = inner_end(mechanics, end, before[c], -1.0, half_m, zero);
        const Lanes gives = load<Lanes>(motor[c].compliance_m_per_N, lane);
        const Lanes pivot = one / (one - gives * inner_motor[c].per_end_m);
        upper[c] = hn::Neg(gives) * inner_motor[c].per_inner_m * pivot;
        value[c] = (load<Lanes>(motor[c].at_m, lane) + gives * inner_motor[c].value_N -
                    load<Lanes>(cable.displacement_m[0], lane)) *
                   pivot;
        by_motor[c] = load<Lanes>(motor[c].per_rad, lane) * pivot;
        store(upper[c], cable.upper[0], lane);
        store(value[c], cable.value[0], lane);
        store(by_motor[c], cable.by_motor[0], lane);
    }

    const Lanes full_rigid_N = mechanics.constant_drag_N(group.segment_m);
    const bool is_rigid = !none_of(hn::Ne(full_rigid_N, zero));
    const Lanes viscous_N_per_m = mechanics.sliding_drag_N_per_m(group.segment_m);
    const Lanes bristle_m = static_cast<const PreslidingLaw<Lanes>&>(mechanics).length_m;
    for (int node = 1; node < last; ++node) {
        guess_segments(group, mechanics, active, node, lane, behind);
        for (int c = 0; c < cables; ++c) {
            const CableLanes& cable = group.cable[c];
            const NodeGuess<Lanes> here =
                node_guess(cable, mechanics, node, moved_m<Lanes>(cable, node, lane), lane);
            // A slack stretch presses on its conduit only by its bending stiffness. There the way to no drag,
            // not the slope of bristles that are fully bent, leads to equilibrium.
            const Lanes sum_N = hn::Max(zero, before[c].value_N + behind[c].value_N);
            const Which<Lanes> pressed = hn::Gt(sum_N, zero);
            const Lanes q = hn::IfThenElseZero(pressed, here.friction * here.bend);
            const Lanes out_of_balance_N = behind[c].value_N - before[c].value_N - q * sum_N -
                                           full_rigid_N * here.bend - viscous_N_per_m * here.dragged_m;
            const Lanes lower = before[c].per_m * (one + q);
            const Lanes above = behind[c].per_m * (one - q);
            const Lanes by_bend_N = here.friction * sum_N + full_rigid_N;
            const Lanes to_no_drag_m = hn::Max(hn::Abs(here.slid_m), bristle_m);
            const Lanes slack_drag = is_rigid ? full_rigid_N / to_no_drag_m : zero;
            const Lanes drag =
                hn::IfThenElse(pressed, by_bend_N * here.bend_per_m, slack_drag) + viscous_N_per_m;
            const Lanes pivot = one / hn::Neg(lower + above + drag + lower * upper[c]);
            upper[c] = above * pivot;
            value[c] = (hn::Neg(out_of_balance_N) - lower * value[c]) * pivot;
            store(upper[c], cable.upper[node], lane);
            store(value[c], cable.value[node], lane);
            if (group.free.motor) {
                by_motor[c] = hn::Neg(lower) * by_motor[c] * pivot;
                store(by_motor[c], cable.by_motor[node], lane);
            }
            before[c] = behind[c];
        }
    }

    // Load end: u_last = at + per_rad turn - compliance T.
    for (int c = 0; c < cables; ++c) {
        const CableLanes& cable = group.cable[c];
        const Lanes of_neighbour = load<Lanes>(group.of_neighbour, lane);
        const Lanes slid_m = slid_at_load_m(cable, last, of_neighbour, lane);
        const InnerEnd<Lanes> inner = inner_end(mechanics, node_guess(cable, mechanics, last, slid_m, lane),
                                                before[c], 1.0, half_m, of_neighbour);
        const Lanes gives = load<Lanes>(load_end[c].compliance_m_per_N, lane);
        const Lanes lower = gives * inner.per_inner_m;
        const Lanes pivot = one / (one + gives * inner.per_end_m - lower * upper[c]);
        Lanes moved = (load<Lanes>(load_end[c].at_m, lane) - gives * inner.value_N -
                       load<Lanes>(cable.displacement_m[last], lane) - lower * value[c]) *
                      pivot;
        Lanes moved_by_motor = group.free.motor ? hn::Neg(lower) * by_motor[c] * pivot : zero;
        Lanes moved_by_load = load<Lanes>(load_end[c].per_rad, lane) * pivot;
        store(moved, cable.value[last], lane);
        store(moved_by_motor, cable.by_motor[last], lane);
        store(moved_by_load, cable.by_load[last], lane);
        const auto set = [&](const InnerEnd<Lanes>& end, EndTensions& of, Lanes v0, Lanes v1, Lanes m0,
                             Lanes m1, Lanes l0, Lanes l1) HWY_ATTR {
            store(end.value_N + end.per_end_m * v0 + end.per_inner_m * v1, of.value_N, lane);
            store(end.per_end_m * m0 + end.per_inner_m * m1, of.per_motor_rad, lane);
            store(end.per_end_m * l0 + end.per_inner_m * l1, of.per_load_rad, lane);
        };
        for (int node = last; node-- > 0;) {
            const Lanes up = load<Lanes>(cable.upper[node], lane);
            const Lanes end_value = moved;
            const Lanes end_by_motor = moved_by_motor;
            const Lanes end_by_load = moved_by_load;
            moved = load<Lanes>(cable.value[node], lane) - up * moved;
            store(moved, cable.value[node], lane);
            if (group.free.motor) {
                moved_by_motor = load<Lanes>(cable.by_motor[node], lane) - up * moved_by_motor;
                store(moved_by_motor, cable.by_motor[node], lane);
            }
            if (group.free.load) {
                moved_by_load = hn::Neg(up) * moved_by_load;
                store(moved_by_load, cable.by_load[node], lane);
            }
            if (node == last - 1)
                set(inner, at_load[c], end_value, moved, end_by_motor, moved_by_motor, end_by_load,
                    moved_by_load);
            if (node == 0)
                set(inner_motor[c], at_motor[c], moved, end_value, moved_by_motor, end_by_motor,
                    moved_by_load, end_by_load);
        }
    }
}

void linearise(const CablesGroup& group, const LaneFlags& active, const EndPlaces* motor,
               const EndPlaces* load_end, EndTensions* at_motor, EndTensions* at_load) {
    for_active_lanes(active, [&](auto tag, int lane) HWY_ATTR {
        using Lanes = hn::Vec<decltype(tag)>;
        const Which<Lanes> which = flags_at<Lanes>(active, lane);
        if (group.cables == 2) {
            linearise_lanes<Lanes, 2>(group, which, lane, motor, load_end, at_motor, at_load);
        } else {
            linearise_lanes<Lanes, 1>(group, which, lane, motor, load_end, at_motor, at_load);
        }
    });
}

void begin(const CablesGroup& group, const LaneFlags& active, const CablesMoment& moment) {
    for_active_lanes(active, [&](auto tag, int lane) HWY_ATTR {
        using Lanes = hn::Vec<decltype(tag)>;
        const Which<Lanes> which = flags_at<Lanes>(active, lane);
        const LaneCable<Lanes> mechanics(group, lane);
        const auto copy = [&](const LaneValues& from, LaneValues& to) HWY_ATTR {
            store(hn::IfThenElse(which, load<Lanes>(from, lane), load<Lanes>(to, lane)), to, lane);
        };
        for (int c = 0; c < group.cables; ++c) {
            const CableLanes& cable = group.cable[c];
            const int last = group.nodes - 1;
            for (int node = 0; node <= last; ++node) copy(cable.before_m[node], cable.displacement_m[node]);
            for (int segment = 0; segment < last; ++segment)
                copy(cable.before_tension_N[segment], cable.tension_N[segment]);
            if (!group.any_varying_friction) continue;
            for (int node = 0; node <= last; ++node) {
                const Lanes tension_N =
                    lanes_of<Lanes>(0.5) *
                    (load<Lanes>(cable.before_tension_N[node < last ? node : last - 1], lane) +
                     load<Lanes>(cable.before_tension_N[node > 0 ? node - 1 : 0], lane));
                const Lanes wrap_rad =
                    hn::Max(lanes_of<Lanes>(0.0), load<Lanes>(cable.wrap_rad[node], lane) +
                                                      load<Lanes>(moment.load_angle_rad, lane) *
                                                          load<Lanes>(cable.wrap_per_load_angle[node], lane));
                const double span_m = (node == 0 || node == last ? 0.5 : 1.0) * group.segment_m;
                const Sliding<Lanes> sliding = {load<Lanes>(cable.lagging_speed_m_per_s[node], lane),
                                                tension_N * wrap_rad / lanes_of<Lanes>(span_m),
                                                load<Lanes>(cable.before_bend[node], lane),
                                                load<Lanes>(moment.session_time_s, lane)};
                const Lanes friction = mechanics.friction(wrap_rad, sliding);
                const Lanes constant = load<Lanes>(cable.friction[node], lane);
                store(hn::IfThenElse(mechanics.varies, friction, constant), cable.friction[node], lane);
            }
        }
    });
}

// No node moves further in one iteration; a node between slack segments has no definite place.
constexpr double max_move_m = 0.05;

LaneValues move(const CablesGroup& group, const LaneFlags& active, const LaneValues& motor_rad,
                const LaneValues& load_rad, const LaneValues& fraction_values) {
    LaneValues largest;
    for_active_lanes(active, [&](auto tag, int lane) HWY_ATTR {
        using Lanes = hn::Vec<decltype(tag)>;
        const Lanes fraction = load<Lanes>(fraction_values, lane);
        const Which<Lanes> moves = hn::Ne(fraction, lanes_of<Lanes>(0.0));
        const Lanes motor = load<Lanes>(motor_rad, lane);
        const Lanes turned = load<Lanes>(load_rad, lane);
        Lanes largest_here = lanes_of<Lanes>(0.0);
        for (int c = 0; c < group.cables; ++c) {
            const CableLanes& cable = group.cable[c];
            for (int node = 0; node < group.nodes; ++node) {
                Lanes move_m = load<Lanes>(cable.value[node], lane);
                if (group.free.motor) move_m = move_m + motor * load<Lanes>(cable.by_motor[node], lane);
                if (group.free.load) move_m = move_m + turned * load<Lanes>(cable.by_load[node], lane);
                const Lanes here = load<Lanes>(cable.displacement_m[node], lane);
                const Lanes step_m = hn::Min(hn::Max(fraction * move_m, lanes_of<Lanes>(-max_move_m)),
                                             lanes_of<Lanes>(max_move_m));
                store(hn::IfThenElse(moves, here + step_m, here), cable.displacement_m[node], lane);
                // A move that is not a number counts as the largest.
                const Lanes size = hn::Abs(move_m);
                largest_here = hn::IfThenElse(hn::Le(size, largest_here), largest_here, size);
            }
        }
        store(largest_here, largest, lane);
    });
    return largest;
}

template <class Lanes, int cables>
HWY_INLINE void keep_lanes(const CablesGroup& group, int lane, LaneValues* motor_tension_N,
                           LaneValues* load_tension_N) {
    const LaneCable<Lanes> mechanics(group, lane);
    const Which<Lanes> all = hn::Eq(lanes_of<Lanes>(0.0), lanes_of<Lanes>(0.0));
    const int last = group.nodes - 1;
    const double half_m = 0.5 * group.segment_m;
    LaneTension<Lanes> first[cables];
    LaneTension<Lanes> final_segment[cables];
    guess_segments(group, mechanics, all, 0, lane, first);
    for (int c = 0; c < cables; ++c) final_segment[c] = first[c];
    for (int segment = 1; segment < last; ++segment)
        guess_segments(group, mechanics, all, segment, lane, final_segment);
    for (int c = 0; c < cables; ++c) {
        const CableLanes& cable = group.cable[c];
        const Lanes of_neighbour = load<Lanes>(group.of_neighbour, lane);
        for (int node = 0; node <= last; ++node) {
            const Lanes slid_m = node < last ? moved_m<Lanes>(cable, node, lane)
                                             : slid_at_load_m(cable, last, of_neighbour, lane);
            const NodeGuess<Lanes> here = node_guess(cable, mechanics, node, slid_m, lane);
            if (node == 0)
                store(inner_end(mechanics, here, first[c], -1.0, half_m, lanes_of<Lanes>(0.0)).value_N,
                      motor_tension_N[c], lane);
            if (node == last)
                store(inner_end(mechanics, here, final_segment[c], 1.0, half_m, of_neighbour).value_N,
                      load_tension_N[c], lane);
            if (mechanics.drags)
                store(slid_m / mechanics.time_step_s, cable.before_speed_m_per_s[node], lane);
            if (!group.any_varying_friction) continue;
            const Lanes speed = hn::Abs(slid_m) / mechanics.time_step_s;
            const Lanes lagging = load<Lanes>(cable.lagging_speed_m_per_s[node], lane);
            store(laws::lagging_speed<Lanes>(mechanics, lagging, speed, mechanics.time_step_s),
                  cable.lagging_speed_m_per_s[node], lane);
        }
        for (int node = 0; node <= last; ++node) {
            store(load<Lanes>(cable.displacement_m[node], lane), cable.before_m[node], lane);
            store(load<Lanes>(cable.bend[node], lane), cable.before_bend[node], lane);
        }
        for (int segment = 0; segment < last; ++segment) {
            const Lanes tension_N = load<Lanes>(cable.tension_N[segment], lane);
            store(tension_N, cable.before_tension_N[segment], lane);
            if (!mechanics.creeps) continue;
            store(load<Lanes>(cable.crept_m[segment], lane) * mechanics.creep_stays +
                      mechanics.step_creep_m_per_N * tension_N,
                  cable.crept_m[segment], lane);
        }
    }
}

void keep(const CablesGroup& group, LaneValues* motor_tension_N, LaneValues* load_tension_N) {
    LaneFlags all;
    std::fill_n(all.of, group.benches, true);
    for_active_lanes(all, [&](auto tag, int lane) HWY_ATTR {
        using Lanes = hn::Vec<decltype(tag)>;
        if (group.cables == 2) {
            keep_lanes<Lanes, 2>(group, lane, motor_tension_N, load_tension_N);
        } else {
            keep_lanes<Lanes, 1>(group, lane, motor_tension_N, load_tension_N);
        }
    });
}

}  // namespace capstan::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {
namespace bench {

HWY_EXPORT(begin);
HWY_EXPORT(linearise);
HWY_EXPORT(move);
HWY_EXPORT(keep);

}  // namespace bench

void begin_cables(const CablesGroup& group, const LaneFlags& active, const CablesMoment& moment) {
    using namespace bench;
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(begin); });
    chosen(group, active, moment);
}

void linearise_cables(const CablesGroup& group, const LaneFlags& active, const EndPlaces* motor,
                      const EndPlaces* load, EndTensions* at_motor, EndTensions* at_load) {
    using namespace bench;
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(linearise); });
    chosen(group, active, motor, load, at_motor, at_load);
}

LaneValues move_cables(const CablesGroup& group, const LaneFlags& active, const LaneValues& motor_rad,
                       const LaneValues& load_rad, const LaneValues& fraction) {
    using namespace bench;
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(move); });
    return chosen(group, active, motor_rad, load_rad, fraction);
}

void store_cables(const CablesGroup& group, LaneValues* motor_tension_N, LaneValues* load_tension_N) {
    using namespace bench;
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(keep); });
    chosen(group, motor_tension_N, load_tension_N);
}

}  // namespace capstan
#endif
