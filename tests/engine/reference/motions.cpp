#include "motions.h"

#include <cmath>
#include <numbers>

#include "example_cables.h"
#include "input_pairs.h"

namespace capstan::test {

namespace {

constexpr double preload_N = 40.0;
constexpr double spring_N_per_m = 40.0;
constexpr double rest_m = -preload_N * 2.0 / 2000.0;  // proximal end, from its 2 m and 2 kN
constexpr int steps_per_cycle = 125;

double sine(int step) {
    return std::sin(2.0 * std::numbers::pi * step / steps_per_cycle);
}
// Incommensurate with the other, and starting at zero.
double other_sine(int step) {
    return std::sin(1.37 * 2.0 * std::numbers::pi * step / steps_per_cycle + 0.4) - std::sin(0.4);
}

// Each end to where it is asked, through a spring of the paper's stiffness where it has one.
EndConditions driven(const InputPair& pair, const EndTarget& proximal, const EndTarget& distal) {
    return ends_of(pair, {preload_N + proximal.tension_N, rest_m + proximal.displacement_m},
                   {preload_N + distal.tension_N, distal.displacement_m}, spring_N_per_m);
}

struct NamedPath {
    std::string name;
    EndConditions (*ends)(int step);
};

constexpr EndKind position = EndKind::position;
constexpr EndKind tension = EndKind::tension;
constexpr EndKind spring = EndKind::spring;

const NamedPath paths[] = {
    {"PartialMotionAgainstASpring",
     [](int n) {
         return driven({position, spring}, {0.0, 0.0015 * sine(n)}, {});
     }},
    {"MassMotionAgainstASpring",
     [](int n) {
         return driven({position, spring}, {0.0, 0.08 * sine(n)}, {});
     }},
    {"MonodirectionalLocked",
     [](int n) {
         return driven({position, position}, {0.0, 0.008 * sine(n)}, {});
     }},
    {"BidirectionalBothEndsDriven",
     [](int n) {
         return driven({position, position}, {0.0, 0.008 * sine(n)}, {0.0, 0.006 * other_sine(n)});
     }},
    {"PositionTension",
     [](int n) {
         return driven({position, tension}, {0.0, 0.02 * sine(n)}, {10.0 * other_sine(n), 0.0});
     }},
    {"TensionPosition",
     [](int n) {
         return driven({tension, position}, {20.0 * sine(n), 0.0}, {0.0, 0.004 * other_sine(n)});
     }},
    {"PositionMovingWall",
     [](int n) {
         return driven({position, spring}, {0.0, 0.01 * sine(n)}, {0.0, 0.4 * other_sine(n)});
     }},
    {"MovingWallPosition",
     [](int n) {
         return driven({spring, position}, {0.0, 0.5 * sine(n)}, {0.0, 0.006 * other_sine(n)});
     }},
    {"MovingWallTension",
     [](int n) {
         return driven({spring, tension}, {0.0, 0.5 * sine(n)}, {10.0 * other_sine(n), 0.0});
     }},
    {"TensionMovingWall",
     [](int n) {
         return driven({tension, spring}, {20.0 * sine(n), 0.0}, {0.0, 0.3 * other_sine(n)});
     }},
    {"TwoMovingWalls",
     [](int n) {
         return driven({spring, spring}, {0.0, 0.5 * sine(n)}, {0.0, 0.4 * other_sine(n)});
     }},
};

}  // namespace

Cable preloaded_cable(int segments, double static_friction) {
    CableSpecification specification = paper_specification(segments);
    specification.pretension_N = preload_N;
    specification.static_friction = static_friction;
    return Cable(specification);
}

std::vector<Motion> all_motions(int steps) {
    std::vector<Motion> motions;
    for (const auto& [name, ends] : paths) {
        for (const double static_friction : {0.21, 0.63}) {
            Motion motion{name + (static_friction > 0.21 ? "WithStiction" : ""), static_friction, {}};
            for (int n = 1; n <= steps; ++n) motion.path.push_back(ends(n));
            motions.push_back(motion);
        }
    }
    return motions;
}

}  // namespace capstan::test
