#include "capstan/solver/quasi_static_step.h"

#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/pattern_search.h"
#include "capstan/solver/sides.h"
#include "capstan/solver/sliding_run.h"
#include "capstan/solver/solvable_ends.h"

namespace capstan {

namespace {

[[gnu::noinline]] StepReport take_what_verifies(const StepView& view, const EndConditions& ends,
                                                CableState& state) {
    const PatternSearch search = search_pattern(view, ends);
    if (!is_finite(search.candidate)) {
        throw InvalidInput(
            {"the ends' inputs ask this cable for a tension or displacement that is not a finite number below "
             "1e150; check the units of the inputs, of the stiffness and of the lengths"});
    }
    write_state(view, search.candidate, ends, state);
    return {search.candidate.pattern, search.verified};
}

}  // namespace

QuasiStaticStep::QuasiStaticStep(const Cable& cable, const ModelRules& rules)
    : cable_(cable), rules_(rules), tables_(cable_, rules) {}

void QuasiStaticStep::set_sliding_exponents(std::span<const double> exponents) {
    if (rules_.elongation != ElongationRule::mean_tension)
        throw InvalidInput(
            {"a step with other friction exponents needs ElongationRule::mean_tension; take "
             "ModelRules::consistent()"});
    if (exponents.size() != tables_.sliding_exponent.size())
        throw InvalidInput({"a step on " + std::to_string(tables_.sliding_exponent.size()) +
                            " segments was given " + std::to_string(exponents.size()) +
                            " friction exponents; give one for each segment"});
    tables_.set_sliding_exponents(exponents);
}

// Nearly every step takes the first candidate pattern: two sides that do not meet or that meet in one
// segment, else mass motion, or a zero-velocity point where the ends are driven against each other. That way
// is laid out in one piece and writes as soon as it knows; any other begins anew with the search.
[[gnu::flatten]] StepReport QuasiStaticStep::advance(CableState& state, const EndConditions& ends) const {
    if (!solvable(ends)) refuse(ends);
    const StepView view{tables_, rules_, state};
    const Sides sides = find_sides(view, ends, FrontStart::remembered);
    Candidate likely;
    if (!sides.meet(view)) {
        if (sides.rest() && state.last_motion.kind == MotionKind::slack) {
            return take_what_verifies(view, ends, state);
        }
        likely = partial_motion(sides.proximal, sides.distal);
    } else if (sides.meet_in_one_segment(view)) {
        likely = partial_motion(sides.proximal, sides.distal);
    } else {
        if (sides.driven_against_each_other()) {
            likely = opposed_motion(view, ends, sides.proximal.direction);
        } else {
            likely = taut_mass_motion(view, ends, sides.common_direction());
        }
        if (!(likely.proximal.tension_N > 0.0)) return take_what_verifies(view, ends, state);
    }
    if (!is_finite(likely) || !resting_nodes_hold(view, likely) ||
        !write_if_both_move(proximal_run(view, likely), distal_run(view, likely), view, state)) {
        return take_what_verifies(view, ends, state);
    }
    pin_ends(likely.pattern, ends, state);
    state.last_motion = likely.pattern;
    return {likely.pattern, true};
}

}  // namespace capstan
