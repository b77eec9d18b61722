#pragma once

#include "capstan/solver/candidate.h"

namespace capstan {

/// Both ends drive the cable against each other and no node rests: finds the zero-velocity point (E7), which
/// is mass motion where it lies at an end. Bisection over nodes, then one scalar root inside a segment.
Candidate opposed_motion(const StepView& view, const EndConditions& ends, Direction proximal,
                         int& patterns_tried);

}  // namespace capstan
