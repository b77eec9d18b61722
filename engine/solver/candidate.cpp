#include "capstan/solver/candidate.h"

#include <algorithm>
#include <cmath>

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

Candidate opposed_at(const StepView& view, const EndConditions& ends, Direction proximal_direction,
                     int last_proximal_node, double fraction) {
    const int p = last_proximal_node;
    const SideTable& near = view.tables.proximal(sign(proximal_direction));
    const SideTable& far = view.tables.distal(-sign(proximal_direction));
    const double exponent =
        view.tables.sliding_exponent[p] * sign(proximal_direction) * (2.0 * fraction - 1.0);
    const double ratio = near.tension_ratio[p] * std::exp(exponent) / far.tension_ratio[p + 1];
    const double elongation = near.front_compliance_m_per_N[p] + ratio * far.front_compliance_m_per_N[p + 1];
    const EndValues proximal = proximal_values(ends, ratio, elongation);
    if (!(proximal.tension_N > 0.0)) return slack(ends);
    const EndValues distal{proximal.tension_N * ratio,
                           proximal.displacement_m + proximal.tension_N * elongation};
    return {{MotionKind::opposed, proximal_direction, opposite(proximal_direction), p + 1,
             view.segments() - p, fraction},
            proximal,
            distal};
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
