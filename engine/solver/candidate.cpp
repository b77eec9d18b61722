#include "capstan/solver/candidate.h"

#include <algorithm>
#include <cmath>

#include "capstan/solver/sliding_run.h"

namespace capstan {

namespace {

// Relative rounding of a tension against the friction cone.
constexpr double tension_rounding = 1e-10;

bool is_position(const EndCondition& end) {
    return end.displacement_factor != 0.0;
}

// Displacement of an end that carries nothing (E6 with T = 0), if its condition says one.
double slack_displacement_m(const EndCondition& end) {
    return end.value / end.displacement_factor;
}

// Solves both end conditions when the distal end has `tension_ratio` times the proximal tension and lies
// `elongation` metres per newton of it further on.
EndValues proximal_values(const EndConditions& ends, double tension_ratio, double elongation_m_per_N) {
    const EndCondition& p = ends.proximal;
    const EndCondition& d = ends.distal;
    const double distal_factor =
        d.displacement_factor * elongation_m_per_N + d.tension_factor * tension_ratio;
    const double determinant =
        p.displacement_factor * distal_factor - p.tension_factor * d.displacement_factor;
    return {(p.displacement_factor * d.value - d.displacement_factor * p.value) / determinant,
            (p.value * distal_factor - p.tension_factor * d.value) / determinant};
}

bool cone_holds(const StepView& view, int segment, double tension_a_N, double tension_b_N) {
    const double ratio = view.holding_ratio(segment) * (1.0 + tension_rounding);
    return tension_a_N <= tension_b_N * ratio && tension_b_N <= tension_a_N * ratio;
}

// A prescribed value is written as prescribed: the rounding of a sum must not drive the next step.
void pin(const EndCondition& end, int node, CableState& state) {
    if (end.tension_factor == 0.0) state.displacement_m[node] = end.value / end.displacement_factor;
    if (end.displacement_factor == 0.0) state.tension_N[node] = end.value / end.tension_factor;
}

void lay_slack(const Candidate& candidate, CableState& state) {
    const double start_m = candidate.proximal.displacement_m;
    const double gap_m = candidate.distal.displacement_m - start_m;
    const int segments = static_cast<int>(state.tension_N.size()) - 1;
    for (int node = 0; node <= segments; ++node) {
        state.tension_N[node] = 0.0;
        state.displacement_m[node] = start_m + gap_m * node / segments;
    }
}

void finish(const MotionPattern& pattern, const EndConditions& ends, CableState& state) {
    if (pattern.proximal_moving_nodes > 0) pin(ends.proximal, 0, state);
    if (pattern.distal_moving_nodes > 0) {
        pin(ends.distal, static_cast<int>(state.tension_N.size()) - 1, state);
    }
    state.last_motion = pattern;
}

}  // namespace

Candidate partial_motion(const SideMotion& proximal, const SideMotion& distal) {
    const bool rests = proximal.moving_nodes + distal.moving_nodes == 0;
    return {{rests ? MotionKind::rest : MotionKind::partial, proximal.direction, distal.direction,
             proximal.moving_nodes, distal.moving_nodes, 0.0},
            proximal.end,
            distal.end};
}

Candidate mass_motion(const StepView& view, const EndConditions& ends, Direction direction) {
    const SideTable& table = view.tables.proximal(sign(direction));
    const int last = view.segments();
    const double ratio = table.tension_ratio[last];
    const double elongation = table.elongation_m_per_N[last];
    const EndValues proximal = proximal_values(ends, ratio, elongation);
    if (!(proximal.tension_N > 0.0)) return slack(ends);
    const EndValues distal{proximal.tension_N * ratio,
                           proximal.displacement_m + proximal.tension_N * elongation};
    return {{MotionKind::mass, direction, direction, view.nodes(), view.nodes(), 0.0}, proximal, distal};
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

double moving_tension_N(const StepView& view, const Candidate& candidate, int node) {
    const MotionPattern& pattern = candidate.pattern;
    return node < pattern.proximal_moving_nodes
               ? candidate.proximal.tension_N *
                     view.tables.proximal(sign(pattern.proximal_direction)).tension_ratio[node]
               : candidate.distal.tension_N *
                     view.tables.distal(sign(pattern.distal_direction)).tension_ratio[node];
}

double moving_displacement_m(const StepView& view, const Candidate& candidate, int node) {
    const MotionPattern& pattern = candidate.pattern;
    return node < pattern.proximal_moving_nodes
               ? candidate.proximal.displacement_m +
                     candidate.proximal.tension_N *
                         view.tables.proximal(sign(pattern.proximal_direction)).elongation_m_per_N[node]
               : candidate.distal.displacement_m -
                     candidate.distal.tension_N *
                         view.tables.distal(sign(pattern.distal_direction)).elongation_m_per_N[node];
}

bool verifies(const StepView& view, const Candidate& candidate) {
    return resting_nodes_hold(view, candidate) && moves(proximal_run(view, candidate), view) &&
           moves(distal_run(view, candidate), view);
}

bool resting_nodes_hold(const StepView& view, const Candidate& candidate) {
    const MotionPattern& pattern = candidate.pattern;
    if (pattern.kind != MotionKind::partial) return true;
    const int last_node = view.segments();
    const int near = pattern.proximal_moving_nodes;
    const int far_first =
        last_node + 1 - pattern.distal_moving_nodes;  // first moving node of the distal side
    if (near == far_first) return holding_reserve(view, candidate) * (1.0 + tension_rounding) >= 1.0;  // E8
    const bool near_holds =
        near == 0 ||
        cone_holds(view, near - 1, moving_tension_N(view, candidate, near - 1), view.tension_N(near));
    const bool far_holds =
        far_first > last_node || cone_holds(view, far_first - 1, view.tension_N(far_first - 1),
                                            moving_tension_N(view, candidate, far_first));
    return near_holds && far_holds;
}

double holding_reserve(const StepView& view, const Candidate& candidate) {
    const int near = candidate.pattern.proximal_moving_nodes;
    if (!(candidate.proximal.tension_N > 0.0 && candidate.distal.tension_N > 0.0)) return 0.0;
    const double a_N = moving_tension_N(view, candidate, near - 1);
    const double b_N = moving_tension_N(view, candidate, near);
    // Both its nodes slide, so mu_d holds it whatever it did before.
    return view.tables.sliding_ratio[near - 1] * std::min(a_N, b_N) / std::max(a_N, b_N);
}

void write_state(const StepView& view, const Candidate& candidate, const EndConditions& ends,
                 CableState& state) {
    if (candidate.pattern.kind == MotionKind::slack) {
        lay_slack(candidate, state);
    } else {
        write_run(proximal_run(view, candidate), state);
        write_run(distal_run(view, candidate), state);
    }
    finish(candidate.pattern, ends, state);
}

bool write_if_verified(const StepView& view, const Candidate& candidate, const EndConditions& ends,
                       CableState& state) {
    if (!resting_nodes_hold(view, candidate)) return false;
    if (candidate.pattern.kind == MotionKind::slack) {
        lay_slack(candidate, state);
    } else if (!write_if_both_move(proximal_run(view, candidate), distal_run(view, candidate), view, state)) {
        return false;
    }
    finish(candidate.pattern, ends, state);
    return true;
}

}  // namespace capstan
