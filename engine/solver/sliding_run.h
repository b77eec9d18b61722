#pragma once

#include "capstan/solver/candidate.h"

namespace capstan {

/// The nodes of one sliding side as the loops over nodes see them: tension = scale * ratio, displacement =
/// anchor + slope * elongation (E1, E2). Empty where the side does not move.
struct SlidingRun {
    int first = 0;
    int end = 0;
    double scale_N = 0.0;
    double anchor_m = 0.0;
    double slope_N = 0.0;
    const double* ratio = nullptr;               // nodes
    const double* elongation_m_per_N = nullptr;  // nodes
};

SlidingRun proximal_run(const StepView& view, const Candidate& candidate);
SlidingRun distal_run(const StepView& view, const Candidate& candidate);

/// The velocity check (E5) over a run that should move in `direction`.
bool moves_along(const SlidingRun& run, Direction direction, const StepView& view);

/// Writes tension and displacement of the run's nodes.
void write_run(const SlidingRun& run, CableState& state);

}  // namespace capstan
