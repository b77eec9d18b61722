#include "capstan/solver/pattern_search.h"

#include <algorithm>
#include <optional>

#include "capstan/solver/sides.h"

namespace capstan {

namespace {

// Sides that meet leave no node at rest. Driven against each other: the zero-velocity point is where it falls
// (E7). Driven one way and met in one segment: its middle rests as long as friction holds it (E8). Else all
// slides.
Candidate from_sides(const StepView& view, const EndConditions& ends, const Sides& sides) {
    if (sides.rest() && view.before.last_motion.kind == MotionKind::slack) return slack(ends);
    if (!sides.meet(view)) return partial_motion(sides.proximal, sides.distal);
    if (sides.driven_against_each_other()) {
        return opposed_motion(view, ends, sides.proximal.direction);
    }
    if (sides.meet_in_one_segment(view)) {
        const Candidate held = partial_motion(sides.proximal, sides.distal);
        if (verifies(view, held)) return held;
    }
    return mass_motion(view, ends, sides.common_direction());
}

// The first candidate did not verify: a remembered front can be too far on, and the ends' own increments can
// mislead about the complete pattern.
std::optional<Candidate> another_that_verifies(const StepView& view, const EndConditions& ends) {
    const Sides anew = find_sides(view, ends, FrontStart::end_of_cable);
    const Candidate again = from_sides(view, ends, anew);
    if (verifies(view, again)) return again;
    for (const Direction direction : {Direction::forward, Direction::backward}) {
        const Candidate mass = mass_motion(view, ends, direction);
        if (verifies(view, mass)) return mass;
        const Candidate opposed = opposed_motion(view, ends, direction);
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
    const Sides sides = find_sides(view, ends, FrontStart::remembered);
    const Candidate likely = from_sides(view, ends, sides);
    if (verifies(view, likely)) return {likely, true};
    const std::optional<Candidate> other = another_that_verifies(view, ends);
    if (!other) return {without_compression(view, ends, likely), false};
    return {*other, true};
}

}  // namespace capstan
