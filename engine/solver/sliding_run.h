#pragma once

#include <algorithm>

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

inline SlidingRun proximal_run(const StepView& view, const Candidate& candidate) {
    const MotionPattern& pattern = candidate.pattern;
    const SideTable& table = view.tables.proximal(sign(pattern.proximal_direction));
    return {0,
            pattern.proximal_moving_nodes,
            pattern.proximal_direction,
            candidate.proximal.tension_N,
            candidate.proximal.displacement_m,
            candidate.proximal.tension_N,
            table.tension_ratio.data(),
            table.elongation_m_per_N.data()};
}

inline SlidingRun distal_run(const StepView& view, const Candidate& candidate) {
    const MotionPattern& pattern = candidate.pattern;
    const SideTable& table = view.tables.distal(sign(pattern.distal_direction));
    // In mass motion the proximal run has all nodes already.
    return {std::max(pattern.proximal_moving_nodes, view.nodes() - pattern.distal_moving_nodes),
            view.nodes(),
            pattern.distal_direction,
            candidate.distal.tension_N,
            candidate.distal.displacement_m,
            -candidate.distal.tension_N,
            table.tension_ratio.data(),
            table.elongation_m_per_N.data()};
}

/// The velocity check (E5) over a run.
bool moves(const SlidingRun& run, const StepView& view);

/// Writes tension and displacement of the run's nodes.
void write_run(const SlidingRun& run, CableState& state);

/// Checks every node of both runs and writes them if all move; else nothing is written.
bool write_if_every_node_moves(const SlidingRun& proximal, const SlidingRun& distal, double* tension_N,
                               double* displacement_m);

/// The same under the rules' check.
inline bool write_if_both_move(const SlidingRun& proximal, const SlidingRun& distal, const StepView& view,
                               CableState& state) {
    if (view.rules.check == VelocityCheck::every_node) {
        return write_if_every_node_moves(proximal, distal, state.tension_N.data(),
                                         state.displacement_m.data());
    }
    if (!moves(proximal, view) || !moves(distal, view)) return false;
    write_run(proximal, state);
    write_run(distal, state);
    return true;
}

}  // namespace capstan
