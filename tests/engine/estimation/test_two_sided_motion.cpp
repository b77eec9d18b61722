// Both ends move, and between the two sides the cable rests: the proximal side follows from the known end
// (E3), the distal one from a reading on it.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "capstan/estimation/pattern_profile.h"
#include "capstan/estimation/single_sensor.h"
#include "paper_experiment.h"

namespace capstan {
namespace {

using test::Instant;

constexpr int cable_segments = 10;

// The instants at which both sides slide and some nodes between them rest, with the pattern of that.
void for_each_instant(const ModelRules& rules,
                      const std::function<void(const Instant&, const DirectionPattern&)>& judge) {
    const QuasiStaticStep model(test::paper_cable(cable_segments), rules);
    for (const double ratio : {-0.6, -0.2, 0.3, 0.7}) {
        CableState now = pretensioned(model.cable());
        const CableState start = now;
        for (int step = 1; step <= 150; ++step) {
            const CableState previous = now;
            const double moved_m = 0.004 * std::sin(2.0 * std::numbers::pi * step / 100.0);
            model.advance(now, {EndCondition::position_m(start.displacement_m.front() + moved_m),
                                EndCondition::position_m(start.displacement_m.back() + ratio * moved_m)});
            const MotionPattern& motion = now.last_motion;
            if (motion.kind != MotionKind::partial) continue;
            if (motion.proximal_moving_nodes < 1 || motion.distal_moving_nodes < 2) continue;
            judge({model, previous, now}, {motion.proximal_moving_nodes - 1, motion.distal_moving_nodes - 1,
                                           motion.proximal_direction, motion.distal_direction});
        }
    }
}

double at_reading(const Affine& value, double reading_N) {
    return value.constant + value.per_reading * reading_N;
}

TEST(TwoSidedMotion, AReadingOfTheDistalSideGivesTheTruthOfBothSides) {
    for (const ModelRules& rules : {ModelRules::paper(), ModelRules::consistent()}) {
        int instants = 0;
        for_each_instant(rules, [&](const Instant& instant, const DirectionPattern& pattern) {
            ++instants;
            for (int sensor = cable_segments - pattern.trailing; sensor <= cable_segments; ++sensor) {
                const auto profile = pattern_profile(instant.problem(), pattern, sensor);
                ASSERT_TRUE(profile.has_value());
                const double reading_N = instant.truth.tension_N[sensor];
                for (int node = 0; node <= cable_segments; ++node) {
                    ASSERT_NEAR(at_reading(profile->tension_N[node], reading_N),
                                instant.truth.tension_N[node], 1e-9);
                    ASSERT_NEAR(at_reading(profile->displacement_m[node], reading_N),
                                instant.truth.displacement_m[node], 1e-12);
                }
                const auto known =
                    known_direction_branch(instant.problem(), instant.truth.last_motion, sensor);
                ASSERT_TRUE(known.has_value());
                EXPECT_EQ(known->directions, direction_bits(pattern, cable_segments));
            }
        });
        EXPECT_GT(instants, 20);
    }
}

TEST(TwoSidedMotion, AReadingOfTheProximalSideOrOfARestingNodeSaysNothingOfTheDistalSide) {
    for_each_instant(ModelRules::paper(), [&](const Instant& instant, const DirectionPattern& pattern) {
        for (int sensor = 0; sensor < cable_segments - pattern.trailing; ++sensor)
            EXPECT_FALSE(pattern_profile(instant.problem(), pattern, sensor).has_value());
    });
}

// The true reading verifies; so does every other at which the sensor's own side moves on and the resting
// nodes beside both fronts hold, and none beyond.
TEST(TwoSidedMotion, VerifiesTheTrueReadingAndNoneAtWhichANodeBesideAFrontGivesWay) {
    for_each_instant(ModelRules::consistent(), [&](const Instant& instant, const DirectionPattern& pattern) {
        const EstimationProblem problem = instant.problem();
        const int front = cable_segments - pattern.trailing;  // of the distal side
        const Cable& cable = instant.step.cable();
        const double ratio = std::exp(cable.static_friction() * cable.wrap_angle_rad()[front - 1]);
        const double resting_N = instant.previous.tension_N[front - 1];
        const auto profile = pattern_profile(problem, pattern, front);
        const ReadingInterval interval = verified_readings(problem, pattern, *profile);
        const double reading_N = instant.truth.tension_N[front];
        EXPECT_LT(interval.low_N, reading_N);
        EXPECT_LT(reading_N, interval.high_N);
        if (pattern.trailing_direction == Direction::forward)
            EXPECT_LE(interval.high_N, resting_N * ratio * (1.0 + 1e-12));
        else
            EXPECT_GE(interval.low_N, resting_N / ratio * (1.0 - 1e-12));
    });
}

}  // namespace
}  // namespace capstan
