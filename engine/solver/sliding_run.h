#pragma once

#include "capstan/solver/candidate.h"

namespace capstan {

/// Rounding of displacements of up to a metre, with three digits to spare: what the velocity check forgives.
inline constexpr double displacement_rounding_m = 1e-12;

/// The nodes of one sliding side as the loops over nodes see them: tension = scale * ratio, displacement =
/// anchor + slope * elongation (E1, E2). Empty where the side does not move.
struct SlidingRun {
    int first = 0;
    int end = 0;
    Direction direction = Direction::none;
    double scale_N = 0.0;
    double anchor_m = 0.0;
    double slope_N = 0.0;
    const double* ratio = nullptr;               // nodes
    const double* elongation_m_per_N = nullptr;  // nodes

    bool empty() const { return first >= end; }
};

SlidingRun proximal_run(const StepView& view, const Candidate& candidate);
SlidingRun distal_run(const StepView& view, const Candidate& candidate);

/// The velocity check (E5) over a run.
bool moves(const SlidingRun& run, const StepView& view);

/// Writes tension and displacement of the run's nodes.
void write_run(const SlidingRun& run, CableState& state);

/// Both runs checked, and written if both move; else `state`, which `view` sees as before, stays as it is.
bool write_if_both_move(const SlidingRun& proximal, const SlidingRun& distal, const StepView& view,
                        CableState& state);

}  // namespace capstan
