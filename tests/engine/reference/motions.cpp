#include "motions.h"

#include <cmath>
#include <numbers>

#include "example_cables.h"

namespace capstan::test {

namespace {

constexpr double preload_N = 40.0;
constexpr double rest_m = -preload_N * 2.0 / 2000.0;  // proximal end, from its 2 m and 2 kN
constexpr int steps_per_cycle = 125;

double sine(int step) {
    return std::sin(2.0 * std::numbers::pi * step / steps_per_cycle);
}
// Incommensurate with the other, and starting at zero.
double other_sine(int step) {
    return std::sin(1.37 * 2.0 * std::numbers::pi * step / steps_per_cycle + 0.4) - std::sin(0.4);
}

EndConditions at_step(const std::string& name, int n) {
    const auto position = [](double moved_m) { return EndCondition::position_m(rest_m + moved_m); };
    const EndCondition spring = distal_spring({40.0, preload_N, 0.0});
    if (name == "PartialMotionAgainstASpring") return {position(0.0015 * sine(n)), spring};
    if (name == "MassMotionAgainstASpring") return {position(0.08 * sine(n)), spring};
    if (name == "MonodirectionalLocked") return {position(0.008 * sine(n)), EndCondition::position_m(0.0)};
    if (name == "BidirectionalBothEndsDriven") {
        return {position(0.008 * sine(n)), EndCondition::position_m(0.006 * other_sine(n))};
    }
    if (name == "PositionTension") {
        return {position(0.02 * sine(n)), EndCondition::tension_N(preload_N + 10.0 * other_sine(n))};
    }
    return {EndCondition::tension_N(preload_N + 20.0 * sine(n)),
            EndCondition::position_m(0.004 * other_sine(n))};
}

}  // namespace

Cable preloaded_cable(int segments, double static_friction) {
    CableSpecification specification = paper_specification(segments);
    specification.pretension_N = preload_N;
    specification.static_friction = static_friction;
    return Cable(specification);
}

std::vector<Motion> all_motions(int steps) {
    std::vector<Motion> motions;
    for (const std::string name :
         {"PartialMotionAgainstASpring", "MassMotionAgainstASpring", "MonodirectionalLocked",
          "BidirectionalBothEndsDriven", "PositionTension", "TensionPosition"}) {
        for (const double static_friction : {0.21, 0.63}) {
            Motion motion{name + (static_friction > 0.21 ? "WithStiction" : ""), static_friction, {}};
            for (int n = 1; n <= steps; ++n) motion.path.push_back(at_step(name, n));
            motions.push_back(motion);
        }
    }
    return motions;
}

}  // namespace capstan::test
