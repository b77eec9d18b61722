#pragma once
// Cables whose every number is drawn, for what holds for all of them.

#include <algorithm>
#include <random>
#include <string>

#include "capstan/plan/study_plan.h"

namespace capstan::testing {

/// A shorter motion and a few named sets.
inline void make_small(StudyPlan& plan) {
    plan.motion.samples = std::min(plan.motion.samples, 120);
    plan.layout_families = {"even", "distal", "both"};
    plan.sensor_counts = {1, 2, 3, 5};
    plan.placement.search = ComparedSets::named;
    plan.uncertainty.is_stated = true;
}

inline StudyPlan random_plan(unsigned number) {
    std::mt19937 random(number);
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    StudyPlan plan;
    plan.name = "random " + std::to_string(number);
    plan.seed = number;
    CableSpecification& cable = plan.transmission.cable;
    const int bends = static_cast<int>(within(1.0, 6.0));
    for (int bend = 0; bend < bends; ++bend) {
        cable.curvature.push_back({within(0.05, 0.4), straight});
        cable.curvature.push_back({within(0.05, 0.3), within(0.05, 0.3)});
    }
    cable.segments = static_cast<int>(within(4.0, 17.0));
    cable.axial_stiffness_N = within(1000.0, 20000.0);
    cable.dynamic_friction = within(0.05, 0.4);
    cable.static_friction = cable.dynamic_friction * within(1.0, 2.0);
    cable.pretension_N = within(5.0, 30.0);
    double length_m = 0.0;
    for (const CurvaturePiece& piece : cable.curvature) length_m += piece.length_m;
    const double stretch_m = cable.pretension_N * length_m / cable.axial_stiffness_N;
    plan.motion.proximal = {.kind = EndKind::position,
                            .amplitude = stretch_m * within(0.1, 0.8),
                            .frequency_Hz = within(0.3, 2.0)};
    plan.motion.distal.kind = number % 2 == 0 ? EndKind::position : EndKind::spring;
    plan.motion.distal.spring_stiffness_N_per_m = number % 2 == 0 ? 0.0 : within(500.0, 5000.0);
    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 120;
    plan.uncertainty.friction_fraction = within(0.0, 0.4);
    plan.uncertainty.wrap_fraction = within(0.0, 0.2);
    plan.uncertainty.stiffness_fraction = within(0.0, 0.2);
    plan.uncertainty.pretension_fraction = within(0.0, 0.3);
    plan.uncertainty.far_end_range_m = stretch_m * within(0.05, 0.6);
    plan.noise_levels = {{"random",
                          {.multiplicative_ratio = within(0.01, 0.2),
                           .additive_N = within(0.02, 0.3),
                           .bias_N = within(0.0, 0.3)}}};
    make_small(plan);
    return plan;
}

}  // namespace capstan::testing
