#pragma once

#include "capstan/cable/cable_state.h"
#include "capstan/solver/cable_end.h"
#include "capstan/solver/end_condition.h"

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

/// Both sides as found. Resting nodes lie between them (E3), or none, and then the middle of the segment
/// between them rests (E8).
Candidate partial_motion(const SideMotion& proximal, const SideMotion& distal);

/// All segments slide one way (E1, E2, E6); slack if that needs a tension of zero or less.
Candidate mass_motion(const StepView& view, const EndConditions& ends, Direction direction);

/// The proximal nodes up to and including `last_proximal_node` slide `proximal`, the others against them; the
/// velocity is zero at `fraction` of the segment between, which carries exponent (2 fraction - 1) (E7).
Candidate opposed_at(const StepView& view, const EndConditions& ends, Direction proximal,
                     int last_proximal_node, double fraction);

/// The cable carries nothing.
Candidate slack(const EndConditions& ends);

/// Tension of a node under a candidate in which it moves.
double moving_tension_N(const StepView& view, const Candidate& candidate, int node);
/// Displacement of a node under a candidate in which it moves.
double moving_displacement_m(const StepView& view, const Candidate& candidate, int node);

/// The rules' velocity check and, next to resting nodes, both sides of the friction cone (E4, E5).
bool verifies(const StepView& view, const Candidate& candidate);

/// The part of it next to resting nodes.
bool resting_nodes_hold(const StepView& view, const Candidate& candidate);

/// How much larger the tension ratio across the segment between two sides that meet could be before it gives
/// way (E4); below 1 it has, and 0 if a side is slack.
double holding_reserve(const StepView& view, const Candidate& candidate);

/// `verifies` and `write_state` in one; `state` stays as it is if the candidate does not verify.
bool write_if_verified(const StepView& view, const Candidate& candidate, const EndConditions& ends,
                       CableState& state);

/// Writes the moving nodes into `state` (which `view` sees as before) and remembers the motion.
void write_state(const StepView& view, const Candidate& candidate, const EndConditions& ends,
                 CableState& state);

}  // namespace capstan
