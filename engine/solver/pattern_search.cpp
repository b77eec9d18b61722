#include "capstan/solver/pattern_search.h"

#include <algorithm>
#include <optional>

#include "capstan/solver/sides.h"

namespace capstan {

namespace {

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
            side_motion(CableEnd<End::proximal>(view, ends), proximal.direction, nodes),
            side_motion(CableEnd<End::distal>(view, ends), distal.direction, view.nodes() - nodes));
        ++patterns_tried;
        const double reserve = holding_reserve(view, held);
        if (reserve > best_reserve && verifies(view, held)) {
            best = held;
            best_reserve = reserve;
        }
    }
    return best;
}

// Sides that meet leave no node at rest. Driven against each other: the zero-velocity point is where it falls
// (E7). Else all slides.
Candidate from_sides(const StepView& view, const EndConditions& ends, const Sides& sides,
                     int& patterns_tried) {
    if (sides.rest() && view.before.last_motion.kind == MotionKind::slack) return slack(ends);
    if (!sides.meet(view)) return partial_motion(sides.proximal, sides.distal);
    if (sides.driven_against_each_other()) {
        return opposed_motion(view, ends, sides.proximal.direction, patterns_tried);
    }
    ++patterns_tried;
    return mass_motion(view, ends, sides.common_direction());
}

// Where sides driven one way meet and not all slides: the middle of a segment between them still rests (E8).
std::optional<Candidate> instead_of_mass(const StepView& view, const EndConditions& ends, const Sides& sides,
                                         int& patterns_tried) {
    if (!sides.meet(view) || !sides.driven_one_way()) return std::nullopt;
    return best_held_middle(view, ends, sides.proximal, sides.distal, patterns_tried);
}

// The first candidate did not verify: a remembered front can be too far on, and the ends' own increments can
// mislead about the complete pattern.
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

bool pushes(const Candidate& candidate) {
    const MotionPattern& pattern = candidate.pattern;
    return (pattern.proximal_moving_nodes > 0 && candidate.proximal.tension_N < 0.0) ||
           (pattern.distal_moving_nodes > 0 && candidate.distal.tension_N < 0.0);
}

// Nothing verifies, and what was found has the cable push: no state to go on from. All slides instead, the
// way that asks for less tension, or the cable is slack.
Candidate without_compression(const StepView& view, const EndConditions& ends, const Candidate& candidate) {
    if (!pushes(candidate)) return candidate;
    const Candidate forward = mass_motion(view, ends, Direction::forward);
    const Candidate backward = mass_motion(view, ends, Direction::backward);
    const auto highest_N = [](const Candidate& c) {
        return std::max(c.proximal.tension_N, c.distal.tension_N);
    };
    return highest_N(forward) <= highest_N(backward) ? forward : backward;
}

}  // namespace

PatternSearch search_pattern(const StepView& view, const EndConditions& ends) {
    int patterns_tried = 0;
    const Sides sides = find_sides(view, ends, FrontStart::remembered, patterns_tried);
    const Candidate likely = from_sides(view, ends, sides, patterns_tried);
    if (verifies(view, likely)) return {likely, true, patterns_tried};
    const std::optional<Candidate> other = another_that_verifies(view, ends, sides, patterns_tried);
    if (!other) return {without_compression(view, ends, likely), false, patterns_tried};
    return {*other, true, patterns_tried};
}

}  // namespace capstan
