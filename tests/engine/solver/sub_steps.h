#pragma once

#include "capstan/solver/quasi_static_step.h"

namespace capstan::test {

/// The state that `count` equal sub-steps reach, the inputs of both ends moving evenly from where they are to
/// `ends`. For a growing count it tends to the state that continuous motion reaches.
struct SubSteps {
    CableState after;
    bool zero_velocity_point = false;  ///< a sub-step had one inside a segment (E7)
    bool verified = true;              ///< every sub-step did
};

inline SubSteps in_sub_steps(const QuasiStaticStep& step, const CableState& before, const EndConditions& ends,
                             int count) {
    const auto on_the_way = [](const EndCondition& end, double displacement_m, double tension_N,
                               double fraction) {
        const double from = end.displacement_factor * displacement_m + end.tension_factor * tension_N;
        return EndCondition{end.displacement_factor, end.tension_factor,
                            from + (end.value - from) * fraction};
    };
    SubSteps result{before};
    for (int k = 1; k <= count; ++k) {
        const double fraction = static_cast<double>(k) / count;
        const EndConditions here{
            on_the_way(ends.proximal, before.displacement_m.front(), before.tension_N.front(), fraction),
            on_the_way(ends.distal, before.displacement_m.back(), before.tension_N.back(), fraction)};
        const StepReport report = step.advance(result.after, k < count ? here : ends);
        result.zero_velocity_point |= report.pattern.kind == MotionKind::opposed;
        result.verified &= report.verified;
    }
    return result;
}

}  // namespace capstan::test
