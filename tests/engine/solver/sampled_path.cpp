#include "sampled_path.h"

#include <cmath>
#include <numbers>

namespace capstan::test {

namespace {

constexpr double cycles = 1.25;

double swing(double time, double per_time, double phase_rad) {
    return std::sin(2.0 * std::numbers::pi * per_time * time + phase_rad) - std::sin(phase_rad);
}

}  // namespace

EndMotion pulled(double time) {
    return {-0.006 * swing(time, 0.25, 0.0), 0.0};
}

EndMotion one_end_cycles(double time) {
    return {0.008 * swing(time, cycles, 0.0), 0.0};
}

EndMotion both_ends_cycle(double time) {
    return {0.006 * swing(time, cycles, 0.0), 0.004 * swing(time, 1.37 * cycles, 0.4)};
}

std::vector<CableState> SampledPath::states(const Cable& cable, int steps_per_instant) const {
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    const double rest_m = state.displacement_m.front();
    const int steps = instants * steps_per_instant;
    std::vector<CableState> kept;
    for (int n = 1; n <= steps; ++n) {
        const EndMotion moved = motion(static_cast<double>(n) / steps);
        step.advance(state, {EndCondition::position_m(rest_m + moved.proximal_m),
                             EndCondition::position_m(moved.distal_m)});
        if (n % steps_per_instant == 0) kept.push_back(state);
    }
    return kept;
}

}  // namespace capstan::test
