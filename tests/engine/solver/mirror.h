#pragma once

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"

namespace capstan::test {

/// The same cable seen from its other end: nodes reversed, displacements and directions negated, tensions
/// kept. Exact to the bit, and its own inverse.
CableSpecification mirrored(const CableSpecification& specification);
EndConditions mirrored(const EndConditions& ends);
MotionPattern mirrored(const MotionPattern& pattern);
CableState mirrored(const CableState& state);

}  // namespace capstan::test
