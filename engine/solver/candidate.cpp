#include "capstan/solver/candidate.h"

#include "capstan/solver/sliding_run.h"

namespace capstan {

namespace {

bool is_position(const EndCondition& end) {
    return end.displacement_factor != 0.0;
}

// Displacement of an end that carries nothing (E6 with T = 0), if its condition says one.
double slack_displacement_m(const EndCondition& end) {
    return end.value / end.displacement_factor;
}

void lay_slack(const PrefixTables& tables, const Candidate& candidate, CableState& state) {
    const double start_m = candidate.proximal.displacement_m;
    const double gap_m = candidate.distal.displacement_m - start_m;
    const std::vector<double>& at = tables.relative_position;
    for (std::size_t node = 0; node < at.size(); ++node) {
        state.tension_N[node] = 0.0;
        state.displacement_m[node] = start_m + gap_m * at[node] / at.back();
    }
}

}  // namespace

Candidate mass_motion(const StepView& view, const EndConditions& ends, Direction direction) {
    const Candidate taut = taut_mass_motion(view, ends, direction);
    return taut.proximal.tension_N > 0.0 ? taut : slack(ends);
}

Candidate slack(const EndConditions& ends) {
    Candidate candidate;
    candidate.pattern.kind = MotionKind::slack;
    // An end whose tension is prescribed follows the other one: just unstretched.
    candidate.proximal.displacement_m =
        slack_displacement_m(is_position(ends.proximal) ? ends.proximal : ends.distal);
    candidate.distal.displacement_m =
        slack_displacement_m(is_position(ends.distal) ? ends.distal : ends.proximal);
    return candidate;
}

bool verifies(const StepView& view, const Candidate& candidate) {
    return resting_nodes_hold(view, candidate) && moves(proximal_run(view, candidate), view) &&
           moves(distal_run(view, candidate), view);
}

void write_state(const StepView& view, const Candidate& candidate, const EndConditions& ends,
                 CableState& state) {
    if (candidate.pattern.kind == MotionKind::slack) {
        lay_slack(view.tables, candidate, state);
    } else {
        write_run(proximal_run(view, candidate), state);
        write_run(distal_run(view, candidate), state);
    }
    pin_ends(candidate.pattern, ends, state);
    state.last_motion = candidate.pattern;
}

}  // namespace capstan
