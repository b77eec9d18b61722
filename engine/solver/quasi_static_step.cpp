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
    // The increment is h / this times the change, and h is positive.
    const double change_per_increment =
        condition.displacement_factor * view.tables.half_compliance_m_per_N -
        end.orientation * condition.tension_factor;
    return (change > 0.0) != std::signbit(change_per_increment) ? Direction::forward : Direction::backward;
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

// Both sides as far as they go.
struct Sides {
    SideMotion proximal;
    SideMotion distal;

    bool meet(const StepView& view) const {
        return proximal.moving_nodes + distal.moving_nodes >= view.nodes();
    }
    bool driven_one_way() const { return proximal.direction == distal.direction; }
    bool driven_against_each_other() const {
        return proximal.direction != Direction::none && distal.direction == opposite(proximal.direction);
    }
};

enum class FrontStart { remembered, end_of_cable };

SideMotion side_from(const CableEnd& end, const StepView& view, FrontStart start, int& patterns_tried) {
    const Direction direction = driven_direction(end, view);
    if (direction == Direction::none) return {};
    const int first = start == FrontStart::remembered
                          ? remembered_front(view.before.last_motion, end.orientation > 0, direction, view.nodes())
                          : 0;
    return find_front(end, view, direction, first, patterns_tried);
}

Sides find_sides(const StepView& view, const EndConditions& ends, FrontStart start, int& patterns_tried) {
    return {side_from(CableEnd::proximal(ends.proximal, view.nodes()), view, start, patterns_tried),
            side_from(CableEnd::distal(ends.distal, view.nodes()), view, start, patterns_tried)};
}

// Sides that meet leave no node at rest. Driven against each other: the zero-velocity point is where it falls
// (E7). Else all slides.
Candidate from_sides(const StepView& view, const EndConditions& ends, const Sides& sides,
                     int& patterns_tried) {
    if (!sides.meet(view)) return partial_motion(sides.proximal, sides.distal);
    if (sides.driven_against_each_other()) {
        return opposed_motion(view, ends, sides.proximal.direction, patterns_tried);
    }
    ++patterns_tried;
    return mass_motion(
        view, ends,
        sides.proximal.direction != Direction::none ? sides.proximal.direction : sides.distal.direction);
}

// Where sides driven one way meet and not all slides: the middle of a segment between them still rests (E8).
std::optional<Candidate> instead_of_mass(const StepView& view, const EndConditions& ends, const Sides& sides,
                                         int& patterns_tried) {
    if (!sides.meet(view) || !sides.driven_one_way()) return std::nullopt;
    return best_held_middle(view, ends, sides.proximal, sides.distal, patterns_tried);
}

// The first candidate did not verify: a remembered front can be too far on, and the ends' own increments can
// mislead about the whole.
std::optional<Candidate> another_that_verifies(const StepView& view, const EndConditions& ends,
                                               const Sides& sides, int& patterns_tried) {
    if (auto held = instead_of_mass(view, ends, sides, patterns_tried)) return held;
    const Sides anew = find_sides(view, ends, FrontStart::end_of_cable, patterns_tried);
    const Candidate again = from_sides(view, ends, anew, patterns_tried);
    if (verifies(view, again)) return again;
    if (auto held = instead_of_mass(view, ends, anew, patterns_tried)) return held;
    for (const Direction direction : {Direction::forward, Direction::backward}) {
        const Candidate mass = mass_motion(view, ends, direction);
        if (verifies(view, mass)) return mass;
        const Candidate opposed = opposed_motion(view, ends, direction, patterns_tried);
        if (verifies(view, opposed)) return opposed;
    }
    return std::nullopt;
}

}  // namespace

QuasiStaticStep::QuasiStaticStep(const Cable& cable, const ModelRules& rules)
    : cable_(cable), rules_(rules), tables_(cable_, rules) {}

StepReport QuasiStaticStep::advance(CableState& state, const EndConditions& ends) const {
    if (!solvable(ends)) refuse(ends);
    const StepView view{tables_, rules_, state};
    int patterns_tried = 0;
    const Sides sides = find_sides(view, ends, FrontStart::remembered, patterns_tried);
    const Candidate likely = from_sides(view, ends, sides, patterns_tried);
    if (write_if_verified(view, likely, ends, state)) return {state.last_motion, true, patterns_tried};

    const std::optional<Candidate> other = another_that_verifies(view, ends, sides, patterns_tried);
    write_state(view, other.value_or(likely), ends, state);
    return {state.last_motion, other.has_value(), patterns_tried};
}

}  // namespace capstan
