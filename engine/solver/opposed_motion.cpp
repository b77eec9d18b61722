#include <cmath>

#include "capstan/solver/pattern_search.h"

namespace capstan {

namespace {

// How far `node` moves along the proximal side's direction.
double increment_m(const StepView& view, const Candidate& candidate, Direction proximal, int node) {
    return sign(proximal) * (moving_displacement_m(view, candidate, node) - view.displacement_m(node));
}

// The pattern whose direction changes exactly at `node`.
Candidate change_at_node(const StepView& view, const EndConditions& ends, Direction proximal, int node) {
    return node < view.segments() ? opposed_at(view, ends, proximal, node, 0.0)
                                  : opposed_at(view, ends, proximal, node - 1, 1.0);
}

// Velocity, interpolated between the segment's nodes, at the assumed zero-velocity point; zero when it is
// one.
double mismatch_m(const StepView& view, const Candidate& candidate, Direction proximal, int segment,
                  double fraction) {
    return (1.0 - fraction) * increment_m(view, candidate, proximal, segment) +
           fraction * increment_m(view, candidate, proximal, segment + 1);
}

}  // namespace

Candidate opposed_motion(const StepView& view, const EndConditions& ends, Direction proximal,
                         int& patterns_tried) {
    // Nodes before the zero-velocity point move with the proximal end, those behind it do not.
    const auto moves_with_proximal = [&](int node, Candidate& candidate) {
        candidate = change_at_node(view, ends, proximal, node);
        ++patterns_tried;
        return candidate.pattern.kind != MotionKind::slack &&
               increment_m(view, candidate, proximal, node) > 0.0;
    };
    Candidate at_with;  // the direction changes at the node `with`
    if (!moves_with_proximal(0, at_with)) return mass_motion(view, ends, opposite(proximal));
    Candidate candidate;
    if (moves_with_proximal(view.segments(), candidate)) return mass_motion(view, ends, proximal);
    int with = 0;
    int against = view.segments();
    while (against - with > 1) {
        const int middle = with + (against - with) / 2;
        if (moves_with_proximal(middle, candidate)) {
            with = middle;
            at_with = candidate;
        } else {
            against = middle;
        }
    }

    // Bracketed secant (Illinois): the mismatch is positive at fraction 0 and not at fraction 1.
    double low = 0.0;
    double high = 1.0;
    candidate = opposed_at(view, ends, proximal, with, high);
    double at_low = mismatch_m(view, at_with, proximal, with, low);
    double at_high = mismatch_m(view, candidate, proximal, with, high);
    int last_side = 0;
    for (int iteration = 0; iteration < 100 && at_high < 0.0; ++iteration) {
        const double fraction = low + (high - low) * at_low / (at_low - at_high);
        candidate = opposed_at(view, ends, proximal, with, fraction);
        const double at_middle = mismatch_m(view, candidate, proximal, with, fraction);
        ++patterns_tried;
        if (at_middle == 0.0 || high - low < 1e-15) break;
        if (at_middle > 0.0) {
            if (fraction == low) break;
            low = fraction;
            at_low = at_middle;
            if (last_side > 0) at_high *= 0.5;
            last_side = 1;
        } else {
            if (fraction == high) break;
            high = fraction;
            at_high = at_middle;
            if (last_side < 0) at_low *= 0.5;
            last_side = -1;
        }
        if (std::abs(at_middle) < 1e-18) break;  // below the rounding of any displacement
    }
    return candidate;
}

}  // namespace capstan
