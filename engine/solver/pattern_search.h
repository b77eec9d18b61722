#pragma once

#include "capstan/solver/candidate.h"

namespace capstan {

/// What a search ended with; the likely candidate if nothing verifies.
struct PatternSearch {
    Candidate candidate;
    bool verified = false;
};

/// Every way to find a step's pattern in turn, until one verifies (engine/README.md, "How a step finds its
/// pattern").
PatternSearch search_pattern(const StepView& view, const EndConditions& ends);

/// For ends that drive the cable against each other while no node rests: finds the zero-velocity point (E7),
/// which is mass motion where it lies at an end. Bisection over nodes, then one scalar root inside a segment.
Candidate opposed_motion(const StepView& view, const EndConditions& ends, Direction proximal);

}  // namespace capstan
