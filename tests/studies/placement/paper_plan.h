#pragma once
// The paper's estimation experiment as a plan, and smaller ones for tests that run it often.

#include <numeric>

#include "capstan/estimation/fusion_method.h"
#include "capstan/plan/study_plan.h"

namespace capstan::test {

inline StudyPlan paper_plan(int repetitions) {
    StudyPlan plan;
    plan.name = "paper";
    plan.repetitions = repetitions;

    CableSpecification& cable = plan.transmission.cable;
    cable.curvature = {{2.0, 0.28}};
    cable.segments = 10;
    cable.axial_stiffness_N = 2000.0;
    cable.dynamic_friction = 0.21;
    cable.static_friction = 0.63;
    cable.pretension_N = 10.0;
    plan.transmission.rules = ModelRules::paper();

    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 200;
    plan.motion.proximal = {EndKind::position, 0.01, 1.0, 0.0, 0.0};

    plan.regimes = {{Regime::mass, {112, 142}, 0.5}, {Regime::partial_proximal, {6, 104}, 0.5}};
    plan.noise_levels = {{"10 %", {0.1, 0.0, 0.0}}};

    plan.layout_families = {"even", "distal", "both"};
    plan.sensor_counts.resize(11);
    std::iota(plan.sensor_counts.begin(), plan.sensor_counts.end(), 1);
    for (const FusionMethod& method : fusion_methods()) plan.fusion_methods.emplace_back(method.name);
    plan.largest_distal_increment_m = 0.00063;
    return plan;
}

/// Few layouts, two noise levels, one of all three kinds.
inline StudyPlan small_plan(int repetitions) {
    StudyPlan plan = paper_plan(repetitions);
    plan.name = "small";
    plan.sensor_counts = {1, 3, 11};
    plan.explicit_layouts = {{2, 7}};
    plan.noise_levels.push_back({"all kinds", {0.05, 0.2, 0.1}});
    plan.curve_points = 64;
    return plan;
}

/// Five nodes, so 31 layouts; one instant in each of two regimes.
inline StudyPlan short_cable_plan(int repetitions, std::uint64_t seed = 1) {
    StudyPlan plan = paper_plan(repetitions);
    plan.name = "short cable";
    plan.seed = seed;
    plan.transmission.cable.segments = 4;
    plan.regimes = {{Regime::mass, {142}, 0.5}, {Regime::partial_proximal, {104}, 0.5}};
    plan.sensor_counts = {1, 2, 3};
    plan.curve_points = 32;
    return plan;
}

}  // namespace capstan::test
