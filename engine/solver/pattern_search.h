#pragma once

#include "capstan/solver/candidate.h"

namespace capstan {

/// What a search ended with; the likely candidate if nothing verifies.
struct PatternSearch {
    Candidate candidate;
    bool verified = false;
    int patterns_tried = 0;
};

/// Every way to find a step's pattern in turn, until one verifies (engine/README.md, "How a step finds its
/// pattern").
PatternSearch search_pattern(const StepView& view, const EndConditions& ends);

}  // namespace capstan
