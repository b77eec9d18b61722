#include "driven_cycle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace capstan::test {

EndConditions DrivenCycle::ends_at(const Cable& cable, int step) const {
    constexpr double spring_N_per_m = 2000.0;
    const double angle = 2.0 * std::numbers::pi * step / steps;
    const CableState rest = pretensioned(cable);
    const double force_N = amplitude_m * cable.axial_stiffness_N() / cable.length_m();
    const auto target = [&](EndTarget end, EndKind kind, double swing) {
        // A position or a wall is moved; a tension is set; both ways at once would be two inputs.
        if (kind == EndKind::tension) return EndTarget{std::max(end.tension_N + force_N * swing, 0.0), 0.0};
        return EndTarget{end.tension_N, end.displacement_m + amplitude_m * swing};
    };
    return ends_of(pair, target(proximal_end(rest), pair.proximal, std::sin(angle)),
                   target(distal_end(rest), pair.distal, 0.6 * std::sin(2.0 * angle)), spring_N_per_m);
}

}  // namespace capstan::test
