#include "capstan/solver/quasi_static_step.h"

#include <cmath>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/pattern_search.h"
#include "capstan/solver/sides.h"
#include "capstan/solver/sliding_run.h"

namespace capstan {

namespace {

bool is_line(const EndCondition& end) {
    // Nothing times a number is nothing, unless the number is not finite.
    const bool finite = 0.0 * end.displacement_factor + 0.0 * end.tension_factor + 0.0 * end.value == 0.0;
    return finite && std::abs(end.displacement_factor) + std::abs(end.tension_factor) > 0.0;
}

bool solvable(const EndConditions& ends) {
    return is_line(ends.proximal) && is_line(ends.distal) &&
           (ends.proximal.displacement_factor != 0.0 || ends.distal.displacement_factor != 0.0);
}

[[noreturn, gnu::noinline]] void refuse(const EndConditions& ends) {
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

[[gnu::noinline]] StepReport take_what_verifies(const StepView& view, const EndConditions& ends,
                                                CableState& state) {
    const PatternSearch search = search_pattern(view, ends);
    write_state(view, search.candidate, ends, state);
    return {search.candidate.pattern, search.verified, search.patterns_tried};
}

}  // namespace

QuasiStaticStep::QuasiStaticStep(const Cable& cable, const ModelRules& rules)
    : cable_(cable), rules_(rules), tables_(cable_, rules) {}

// Nearly every step takes the first pattern thought of: two sides that do not meet, or mass motion where they
// do. That way is laid out in one piece and writes as soon as it knows; any other begins anew with the
// search.
[[gnu::flatten]] StepReport QuasiStaticStep::advance(CableState& state, const EndConditions& ends) const {
    if (!solvable(ends)) refuse(ends);
    const StepView view{tables_, rules_, state};
    int patterns_tried = 0;
    const Sides sides = find_sides(view, ends, FrontStart::remembered, patterns_tried);
    Candidate likely;
    if (!sides.meet(view)) {
        likely = partial_motion(sides.proximal, sides.distal);
    } else {
        if (sides.driven_against_each_other()) return take_what_verifies(view, ends, state);
        likely = taut_mass_motion(view, ends, sides.common_direction());
        if (!(likely.proximal.tension_N > 0.0)) return take_what_verifies(view, ends, state);
        ++patterns_tried;
    }
    if (!resting_nodes_hold(view, likely) ||
        !write_if_both_move(proximal_run(view, likely), distal_run(view, likely), view, state)) {
        return take_what_verifies(view, ends, state);
    }
    pin_ends(likely.pattern, ends, state);
    state.last_motion = likely.pattern;
    return {likely.pattern, true, patterns_tried};
}

}  // namespace capstan
