#include "capstan/solver/quasi_static_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/cable_end.h"
#include "capstan/solver/candidate.h"
#include "capstan/solver/opposed_motion.h"

namespace capstan {

namespace {

bool is_line(const EndCondition& end) {
    return std::isfinite(end.displacement_factor) && std::isfinite(end.tension_factor) &&
           std::isfinite(end.value) && (end.displacement_factor != 0.0 || end.tension_factor != 0.0);
}

bool solvable(const EndConditions& ends) {
    return is_line(ends.proximal) && is_line(ends.distal) &&
           (ends.proximal.displacement_factor != 0.0 || ends.distal.displacement_factor != 0.0);
}

[[noreturn]] void refuse(const EndConditions& ends) {
    std::vector<std::string> problems;
    const auto check = [&](const EndCondition& end, const char* name) {
        if (!std::isfinite(end.displacement_factor) || !std::isfinite(end.tension_factor) ||
            !std::isfinite(end.value)) {
            problems.push_back(std::string("the ") + name + " end's input is not a finite number");
        } else if (end.displacement_factor == 0.0 && end.tension_factor == 0.0) {
            problems.push_back(std::string("the ") + name + " end's input says nothing: both factors are 0");
        }
    };
    check(ends.proximal, "proximal");
    check(ends.distal, "distal");
    if (problems.empty()) {
        problems.push_back(
            "a tension is prescribed at both ends, so the displacement is undetermined; prescribe a position "
            "or a spring at one end");
    }
    throw InvalidInput(problems);
}

// Which way an end node would go if it moved alone against its resting neighbour (E3 with E6); an input that
// has not changed beyond rounding drives nothing.
Direction driven_direction(const CableEnd& end, const StepView& view) {
    const EndCondition& condition = end.condition;
    const double displacement_part = condition.displacement_factor * view.displacement_m(end.node(0));
    const double tension_part = condition.tension_factor * view.tension_N(end.node(0));
    const double change = condition.value - (displacement_part + tension_part);
    const double displacement_scale_m =
        std::abs(view.displacement_m(0)) + std::abs(view.displacement_m(view.segments()));
    const double rounding = 64.0 * std::numeric_limits<double>::epsilon() *
                            (std::abs(condition.displacement_factor) * displacement_scale_m +
                             std::abs(tension_part) + std::abs(condition.value));
    if (std::abs(change) <= rounding) return Direction::none;
    const double compliance = view.tables.half_compliance_m_per_N;
    const double increment_per_change = compliance / (condition.displacement_factor * compliance -
                                                      end.orientation * condition.tension_factor);
    return direction_of(change * increment_per_change);
}

// True if the resting node next to the front cannot hold and joins the motion (E4).
bool neighbour_gives_way(const CableEnd& end, const StepView& view, Direction direction, int moving_nodes,
                         double last_tension_N) {
    const double resting_tension_N = view.tension_N(end.node(moving_nodes));
    const double ratio = view.holding_ratio(end.segment(moving_nodes - 1));
    return end.orientation * sign(direction) > 0 ? resting_tension_N >= last_tension_N * ratio
                                                 : last_tension_N >= resting_tension_N * ratio;
}

SideMotion side_motion(const CableEnd& end, const StepView& view, Direction direction, int moving_nodes) {
    return {direction, moving_nodes,
            end.partial_motion(view, end.table(view.tables, direction), moving_nodes)};
}

// Moves a side's front on until its resting neighbour holds; `nodes` when nothing holds.
SideMotion find_front(const CableEnd& end, const StepView& view, Direction direction, int first_count,
                      int& patterns_tried) {
    const SideTable& table = end.table(view.tables, direction);
    const int nodes = view.nodes();
    for (int count = std::max(first_count, 1); count < nodes; ++count) {
        const EndValues values = end.partial_motion(view, table, count);
        ++patterns_tried;
        const double last_tension_N = values.tension_N * table.tension_ratio[end.node(count - 1)];
        if (!neighbour_gives_way(end, view, direction, count, last_tension_N))
            return {direction, count, values};
    }
    return {direction, nodes, {}};
}

// How many nodes the side moved in the step before, if it goes on the same way; else 0: start at the end.
int remembered_front(const MotionPattern& last, bool proximal, Direction direction, int nodes) {
    if (last.kind == MotionKind::slack) return nodes;
    const Direction before = proximal ? last.proximal_direction : last.distal_direction;
    const int count = proximal ? last.proximal_moving_nodes : last.distal_moving_nodes;
    return before == direction ? count : 0;
}

// The middle of a segment where the sides meet rests (E8). Where more than one segment could hold, the one
// that is furthest from giving way does: the same one whichever end is called proximal.
std::optional<Candidate> best_held_middle(const StepView& view, const EndConditions& ends,
                                          const SideMotion& proximal, const SideMotion& distal,
                                          int& patterns_tried) {
    std::optional<Candidate> best;
    double best_reserve = 0.0;
    const int most = std::min(proximal.moving_nodes, view.segments());
    for (int nodes = std::max(view.nodes() - distal.moving_nodes, 1); nodes <= most; ++nodes) {
        const Candidate held = partial_motion(
            side_motion(CableEnd::proximal(ends.proximal, view.nodes()), view, proximal.direction, nodes),
            side_motion(CableEnd::distal(ends.distal, view.nodes()), view, distal.direction,
                        view.nodes() - nodes));
        ++patterns_tried;
        const double reserve = holding_reserve(view, held);
        if (reserve > best_reserve && verifies(view, held)) {
            best = held;
            best_reserve = reserve;
        }
    }
    return best;
}

// The sides meet and no node rests. Driven against each other: the zero-velocity point is where it falls
// (E7). Driven one way: all slides, or the middle of a segment between the sides still rests (E8).
Candidate where_sides_meet(const StepView& view, const EndConditions& ends, const SideMotion& proximal,
                           const SideMotion& distal, int& patterns_tried) {
    if (proximal.direction != Direction::none && distal.direction == opposite(proximal.direction)) {
        return opposed_motion(view, ends, proximal.direction, patterns_tried);
    }
    const Direction direction = proximal.direction != Direction::none ? proximal.direction : distal.direction;
    const Candidate mass = mass_motion(view, ends, direction);
    ++patterns_tried;
    if (proximal.direction != distal.direction || verifies(view, mass)) return mass;
    return best_held_middle(view, ends, proximal, distal, patterns_tried).value_or(mass);
}

Candidate from_fronts(const StepView& view, const EndConditions& ends, bool remember, int& patterns_tried) {
    const CableEnd proximal = CableEnd::proximal(ends.proximal, view.nodes());
    const CableEnd distal = CableEnd::distal(ends.distal, view.nodes());
    const Direction proximal_direction = driven_direction(proximal, view);
    const Direction distal_direction = driven_direction(distal, view);
    const auto side = [&](const CableEnd& end, Direction direction) -> SideMotion {
        if (direction == Direction::none) return {};
        const int first =
            remember ? remembered_front(view.before.last_motion, end.orientation > 0, direction, view.nodes())
                     : 0;
        return find_front(end, view, direction, first, patterns_tried);
    };
    const SideMotion proximal_side = side(proximal, proximal_direction);
    const SideMotion distal_side = side(distal, distal_direction);
    if (proximal_side.moving_nodes + distal_side.moving_nodes < view.nodes()) {
        return partial_motion(proximal_side, distal_side);
    }
    return where_sides_meet(view, ends, proximal_side, distal_side, patterns_tried);
}

}  // namespace

QuasiStaticStep::QuasiStaticStep(const Cable& cable, const ModelRules& rules)
    : cable_(cable), rules_(rules), tables_(cable_, rules) {}

StepReport QuasiStaticStep::advance(CableState& state, const EndConditions& ends) const {
    if (!solvable(ends)) refuse(ends);
    const StepView view{tables_, rules_, state};
    int patterns_tried = 0;

    Candidate candidate = from_fronts(view, ends, true, patterns_tried);
    bool verified = verifies(view, candidate);
    if (!verified) {
        // A remembered front can be too far on, and the ends' own increments can mislead about the whole.
        const auto retry = [&](const Candidate& other) {
            if (!verified && verifies(view, other)) {
                candidate = other;
                verified = true;
            }
        };
        retry(from_fronts(view, ends, false, patterns_tried));
        for (const Direction direction : {Direction::forward, Direction::backward}) {
            retry(mass_motion(view, ends, direction));
            retry(opposed_motion(view, ends, direction, patterns_tried));
        }
    }
    write_state(view, candidate, ends, state);
    return {state.last_motion, verified, patterns_tried};
}

}  // namespace capstan
