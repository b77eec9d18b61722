#pragma once
// Small studies over worlds that several tests share.

#include <cstdint>
#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan::testing {

// A short study of an arm with a moved far end.
inline StudyPlan arm_plan(int worlds = 40) {
    StudyPlan plan;
    plan.name = "arm";
    plan.seed = 11;
    plan.repetitions = worlds;
    plan.transmission.cable = {.curvature = {{0.4, straight}, {0.2, 0.12}, {0.2, straight}, {0.2, 0.08}},
                               .segments = 10,
                               .axial_stiffness_N = 9000.0,
                               .dynamic_friction = 0.12,
                               .static_friction = 0.16,
                               .pretension_N = 15.0};
    plan.motion.proximal = {.kind = EndKind::position, .amplitude = 0.002, .frequency_Hz = 1.0};
    plan.motion.distal.kind = EndKind::position;
    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 80;
    plan.uncertainty.is_stated = true;
    plan.uncertainty.far_end_range_m = 0.001;
    plan.uncertainty.members = 32;
    plan.layout_families = {"even", "distal", "both"};
    plan.sensor_counts = {1, 2, 3};
    plan.noise_levels = {{"3 %", {.multiplicative_ratio = 0.03, .additive_N = 0.1}}};
    plan.worthwhile_gain_N = 0.02;
    return plan;
}

// The quickest: few segments, few samples.
inline StudyPlan small_plan(std::uint64_t seed, int worlds) {
    StudyPlan plan = arm_plan(worlds);
    plan.name = "small";
    plan.seed = seed;
    plan.transmission.cable.curvature = {{0.4, straight}, {0.3, 0.1}, {0.3, straight}};
    plan.transmission.cable.segments = 6;
    plan.motion.sample_rate_Hz = 50.0;
    plan.motion.samples = 40;
    return plan;
}

// The arm between two ends whose positions are given, in fast motion.
inline StudyPlan fast_arm() {
    StudyPlan plan = arm_plan();
    plan.name = "fast arm";
    plan.seed = 5;
    plan.transmission.cable.segments = 20;
    plan.transmission.cable.static_friction = 0.12;
    plan.transmission.cable.pretension_N = 25.0;
    plan.motion.samples = 150;
    plan.uncertainty.members = 64;
    plan.sensors = {{SensorKind::tension, {0.0, 1.0}, {0.03, 0.5, 0.0, 0.0}, 1.0}};
    plan.layout_families = {"both", "distal"};
    plan.sensor_counts = {1, 2};
    return plan;
}

// Two such cables as a pull-pull pair; the motor's torque is the cheapest sensor.
inline StudyPlan pair_plan() {
    StudyPlan plan = arm_plan();
    plan.name = "pair";
    plan.seed = 4;
    plan.transmission.arrangement = CableArrangement::pull_pull;
    plan.transmission.cable.segments = 8;
    plan.transmission.cable.pretension_N = 30.0;
    plan.motion.proximal.amplitude = 0.0015;
    plan.uncertainty.members = 64;
    plan.sensors = {{SensorKind::motor_torque, {}, {0.02, 0.5, 0.0, 0.0}, 1.0},
                    {SensorKind::load_displacement, {}, {0.0, 1e-4, 0.0, 0.0}, 2.0},
                    {SensorKind::tension, {0.0, 1.0}, {0.02, 0.5, 0.0, 0.0}, 3.0}};
    plan.layout_families = {"distal"};
    plan.sensor_counts = {1};
    return plan;
}

}  // namespace capstan::testing
