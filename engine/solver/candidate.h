#pragma once

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/cable_end.h"
#include "capstan/solver/end_condition.h"
#include "capstan/solver/solvable_ends.h"

namespace capstan {

/// One sliding side of a candidate.
struct SideMotion {
    Direction direction = Direction::none;
    int moving_nodes = 0;
    EndValues end;
};

/// A motion pattern and the closed-form solution under it, not yet checked and not yet written out.
struct Candidate {
    MotionPattern pattern;
    EndValues proximal;
    EndValues distal;
};

/// The cable carries nothing.
Candidate slack(const EndConditions& ends);

/// Solves both end conditions when the distal end has `tension_ratio` times the proximal tension and lies
/// `elongation` metres per newton of it further on.
inline EndValues proximal_values(const EndConditions& ends, double tension_ratio, double elongation_m_per_N) {
    const EndCondition& p = ends.proximal;
    const EndCondition& d = ends.distal;
    const double distal_factor =
        d.displacement_factor * elongation_m_per_N + d.tension_factor * tension_ratio;
    const double determinant =
        p.displacement_factor * distal_factor - p.tension_factor * d.displacement_factor;
    return {(p.displacement_factor * d.value - d.displacement_factor * p.value) / determinant,
            (p.value * distal_factor - p.tension_factor * d.value) / determinant};
}

/// Both sides as found. Resting nodes lie between them (E3), or none, and then the middle of the segment
/// between them rests (E8).
inline Candidate partial_motion(const SideMotion& proximal, const SideMotion& distal) {
    const bool rests = proximal.moving_nodes + distal.moving_nodes == 0;
    return {{rests ? MotionKind::rest : MotionKind::partial, proximal.direction, distal.direction,
             proximal.moving_nodes, distal.moving_nodes, 0.0},
            proximal.end,
            distal.end};
}

/// All segments slide one way (E1, E2, E6); of no use if that needs a tension of zero or less.
inline Candidate taut_mass_motion(const StepView& view, const EndConditions& ends, Direction direction) {
    const SideTable& table = view.tables.proximal(sign(direction));
    const int last = view.segments();
    const double ratio = table.tension_ratio[last];
    const double elongation = table.elongation_m_per_N[last];
    const EndValues proximal = proximal_values(ends, ratio, elongation);
    const EndValues distal{proximal.tension_N * ratio,
                           proximal.displacement_m + proximal.tension_N * elongation};
    return {{MotionKind::mass, direction, direction, view.nodes(), view.nodes(), 0.0}, proximal, distal};
}

/// The same, slack if it needs a tension of zero or less.
Candidate mass_motion(const StepView& view, const EndConditions& ends, Direction direction);

/// Tension of a node under a candidate in which it moves.
inline double moving_tension_N(const StepView& view, const Candidate& candidate, int node) {
    const MotionPattern& pattern = candidate.pattern;
    return node < pattern.proximal_moving_nodes
               ? candidate.proximal.tension_N *
                     view.tables.proximal(sign(pattern.proximal_direction)).tension_ratio[node]
               : candidate.distal.tension_N *
                     view.tables.distal(sign(pattern.distal_direction)).tension_ratio[node];
}

/// Relative rounding of a tension against the friction cone.
inline constexpr double tension_rounding = 1e-10;

inline bool cone_holds(const StepView& view, int segment, double tension_a_N, double tension_b_N) {
    const double ratio = view.holding_ratio(segment) * (1.0 + tension_rounding);
    return tension_a_N <= tension_b_N * ratio && tension_b_N <= tension_a_N * ratio;
}

/// How much larger the tension ratio across the segment between two sides that meet could be before it gives
/// way (E4); below 1 it has, and 0 if a side is slack.
inline double holding_reserve(const StepView& view, const Candidate& candidate) {
    const int near = candidate.pattern.proximal_moving_nodes;
    if (!(candidate.proximal.tension_N > 0.0 && candidate.distal.tension_N > 0.0)) return 0.0;
    const double a_N = moving_tension_N(view, candidate, near - 1);
    const double b_N = moving_tension_N(view, candidate, near);
    // Both its nodes slide, so mu_d holds it whatever it did before.
    return view.tables.sliding_ratio[near - 1] * std::min(a_N, b_N) / std::max(a_N, b_N);
}

/// Both sides of the friction cone next to resting nodes (E4).
inline bool resting_nodes_hold(const StepView& view, const Candidate& candidate) {
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

/// Input and cable may each be a number and what comes of them not.
inline bool is_finite(const Candidate& candidate) {
    return std::abs(candidate.proximal.tension_N) <= largest_number &&
           std::abs(candidate.proximal.displacement_m) <= largest_number &&
           std::abs(candidate.distal.tension_N) <= largest_number &&
           std::abs(candidate.distal.displacement_m) <= largest_number;
}

/// The rules' velocity check and the friction cone (E4, E5).
bool verifies(const StepView& view, const Candidate& candidate);

/// A prescribed value is written as prescribed: the rounding of a sum must not drive the next step.
inline void pin(const EndCondition& end, int node, CableState& state) {
    if (end.tension_factor == 0.0) state.displacement_m[node] = end.value / end.displacement_factor;
    if (end.displacement_factor == 0.0) state.tension_N[node] = end.value / end.tension_factor;
}
inline void pin_ends(const MotionPattern& pattern, const EndConditions& ends, CableState& state) {
    if (pattern.proximal_moving_nodes > 0) pin(ends.proximal, 0, state);
    if (pattern.distal_moving_nodes > 0) {
        pin(ends.distal, static_cast<int>(state.tension_N.size()) - 1, state);
    }
}

/// Writes the moving nodes into `state` (which `view` sees as before) and remembers the motion.
void write_state(const StepView& view, const Candidate& candidate, const EndConditions& ends,
                 CableState& state);

}  // namespace capstan
