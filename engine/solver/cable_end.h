#pragma once

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"
#include "capstan/solver/prefix_tables.h"

namespace capstan {

/// What every part of a step reads and none changes: the cable's tables and the state before the step.
struct StepView {
    const PrefixTables& tables;
    const ModelRules& rules;
    const CableState& before;

    int nodes() const { return static_cast<int>(before.tension_N.size()); }
    int segments() const { return nodes() - 1; }
    double tension_N(int node) const { return before.tension_N[node]; }
    double displacement_m(int node) const { return before.displacement_m[node]; }
    /// Tension ratio that friction can hold across a segment next to a resting node (E4).
    double holding_ratio(int segment) const {
        const bool slid = segment_direction(before.last_motion, segment, segments()) != Direction::none;
        return slid && rules.stiction == StictionRule::remembers_sliding ? tables.sliding_ratio[segment]
                                                                         : tables.breakaway_ratio[segment];
    }
};

/// Tension and displacement of an end node; all of a sliding side follows from them.
struct EndValues {
    double tension_N = 0.0;
    double displacement_m = 0.0;
};

/// One end of the cable seen outward from it, so that both ends share one code: k = 0 is the end node, and
/// `orientation` is +1 where outward is towards the distal end, -1 where it is towards the proximal one.
struct CableEnd {
    EndCondition condition;
    int end_node = 0;
    int orientation = 1;

    static CableEnd proximal(const EndCondition& condition, int) { return {condition, 0, 1}; }
    static CableEnd distal(const EndCondition& condition, int nodes) { return {condition, nodes - 1, -1}; }

    int node(int k) const { return end_node + orientation * k; }
    int segment(int k) const { return orientation > 0 ? k : end_node - 1 - k; }

    const SideTable& table(const PrefixTables& tables, Direction direction) const {
        return orientation > 0 ? tables.proximal(sign(direction)) : tables.distal(sign(direction));
    }

    /// The first `moving_nodes` nodes slide, the next one rests (E3 with E6): two lines in u and T of the
    /// end.
    EndValues partial_motion(const StepView& view, const SideTable& side, int moving_nodes) const {
        const int resting = node(moving_nodes);
        const double compliance = side.front_compliance_m_per_N[node(moving_nodes - 1)];
        const double anchor_m = view.displacement_m(resting) -
                                orientation * view.tables.half_compliance_m_per_N * view.tension_N(resting);
        const double tension_N =
            (condition.value - condition.displacement_factor * anchor_m) /
            (condition.tension_factor - orientation * condition.displacement_factor * compliance);
        return {tension_N, anchor_m - orientation * compliance * tension_N};
    }
};

}  // namespace capstan
