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

enum class End { proximal, distal };

/// One end of the cable seen outward from it, so that both ends share one code: k = 0 is the end node, and
/// `orientation` is +1 where outward is towards the distal end, -1 where it is towards the proximal one.
template <End which>
struct CableEnd {
    static constexpr int orientation = which == End::proximal ? 1 : -1;

    const StepView& view;
    const EndCondition& condition;

    CableEnd(const StepView& step, const EndConditions& ends)
        : view(step), condition(which == End::proximal ? ends.proximal : ends.distal) {}

    int node(int k) const { return which == End::proximal ? k : view.segments() - k; }
    int segment(int k) const { return which == End::proximal ? k : view.segments() - 1 - k; }

    const SideTable& table(Direction direction) const {
        return which == End::proximal ? view.tables.proximal(sign(direction))
                                      : view.tables.distal(sign(direction));
    }
    Direction last_direction() const {
        const MotionPattern& last = view.before.last_motion;
        return which == End::proximal ? last.proximal_direction : last.distal_direction;
    }
    int last_moving_nodes() const {
        const MotionPattern& last = view.before.last_motion;
        return which == End::proximal ? last.proximal_moving_nodes : last.distal_moving_nodes;
    }

    /// The first `moving_nodes` nodes slide, the next one rests (E3 with E6): two lines in u and T of the
    /// end.
    EndValues partial_motion(const SideTable& side, int moving_nodes) const {
        const int resting = node(moving_nodes);
        const double compliance = side.front_compliance_m_per_N[node(moving_nodes - 1)];
        const double half = view.tables.half_compliance_m_per_N[segment(moving_nodes - 1)];
        const double anchor_m = view.displacement_m(resting) - orientation * half * view.tension_N(resting);
        const double tension_N =
            (condition.value - condition.displacement_factor * anchor_m) /
            (condition.tension_factor - orientation * condition.displacement_factor * compliance);
        return {tension_N, anchor_m - orientation * compliance * tension_N};
    }
};

}  // namespace capstan
