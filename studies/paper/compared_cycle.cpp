#include "capstan/paper/compared_cycle.h"

#include <cmath>
#include <numbers>

namespace capstan::paper {

namespace {

constexpr double preload_N = 40.0;

EndConditions ends_at(const Cable& cable, ComparedMotion motion, int step) {
    const double angle = 2.0 * std::numbers::pi * step / steps_per_cycle;
    const auto proximal = [&](double stroke_m) {
        const double rest_m = -preload_N * cable.length_m() / cable.axial_stiffness_N();
        return EndCondition::position_m(rest_m + stroke_m * std::sin(angle));
    };
    const EndCondition spring = distal_spring({40.0, preload_N, 0.0});
    switch (motion) {
        case ComparedMotion::mass:
            return {proximal(0.08), spring};
        case ComparedMotion::partial:
            return {proximal(0.0015), spring};
        case ComparedMotion::monodirectional:
            return {proximal(0.008), EndCondition::position_m(0.0)};
        case ComparedMotion::bidirectional:
            return {proximal(0.008),
                    EndCondition::position_m(0.006 * (std::sin(1.37 * angle + 0.4) - std::sin(0.4)))};
    }
    return {};
}

}  // namespace

Cable preloaded_cable(int segments) {
    CableSpecification specification;
    specification.curvature = {{2.0, 0.28}};
    specification.segments = segments;
    specification.axial_stiffness_N = 2000.0;
    specification.dynamic_friction = 0.21;
    specification.static_friction = 0.63;
    specification.pretension_N = preload_N;
    return Cable(specification);
}

std::vector<EndConditions> cycle_of(const Cable& cable, ComparedMotion motion) {
    std::vector<EndConditions> cycle;
    for (int n = 1; n <= steps_per_cycle; ++n) cycle.push_back(ends_at(cable, motion, n));
    return cycle;
}

std::string name_of(ComparedMotion motion) {
    switch (motion) {
        case ComparedMotion::mass:
            return "mass";
        case ComparedMotion::partial:
            return "partial";
        case ComparedMotion::monodirectional:
            return "monodirectional";
        case ComparedMotion::bidirectional:
            return "bidirectional";
    }
    return {};
}

}  // namespace capstan::paper
