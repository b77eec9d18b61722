// Cables that do not match, coarse steps, both pulleys driven: what can go wrong is a torque inside a jump.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "capstan/solver/pull_pull.h"

namespace capstan {
namespace {

class RandomPairs : public testing::TestWithParam<int> {};  // which inputs

TEST_P(RandomPairs, KeepFiniteTensionsAndMeetNearlyEveryTorque) {
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto random_cable = [&] {
        CableSpecification specification;
        specification.curvature = {{uniform(0.2, 2.0), uniform(0.05, 1.0)}, {uniform(0.1, 1.0), straight}};
        specification.segments = static_cast<int>(uniform(1.0, 40.0));
        specification.axial_stiffness_N = uniform(500.0, 5000.0);
        specification.dynamic_friction = uniform(0.0, 0.6);
        specification.static_friction = specification.dynamic_friction * uniform(1.0, 3.0);
        specification.pretension_N = uniform(0.0, 30.0);
        return Cable(specification);
    };
    int steps = 0;
    int unmet = 0;
    for (int pairs = 0; pairs < 40; ++pairs) {
        const Cable cable_a = random_cable();
        const Cable cable_b = random_cable();
        const PullPull pair(cable_a, cable_b, {uniform(0.005, 0.05), uniform(0.01, 0.1)});
        const double motor_rate = uniform(0.01, 0.1);
        const double load_rate = uniform(0.01, 0.1);
        const double motor_size = uniform(0.01, 3.0);
        const double load_size = uniform(0.01, 1.0);
        PullPullState state = pair.at_rest();
        for (int n = 1; n <= 200; ++n) {
            const double motor = motor_size * std::sin(motor_rate * n);
            const double load = load_size * std::sin(load_rate * n);
            const PullPullInputs choices[] = {{MotorAngle{motor}, LoadAngle{load}},
                                              {MotorTorque{0.3 * motor}, LoadAngle{load}},
                                              {MotorAngle{motor}, LoadTorque{load}},
                                              {MotorAngle{motor}, LoadSpring{3.0, load}},
                                              {MotorTorque{0.3 * motor}, LoadSpring{3.0, load}}};
            const PullPullReport report = pair.advance(state, choices[GetParam()]);
            ++steps;
            if (!report.motor.converged || !report.load.converged) ++unmet;
            for (const CableState* cable : {&state.cable_a, &state.cable_b}) {
                for (const double tension_N : cable->tension_N) {
                    ASSERT_TRUE(std::isfinite(tension_N) && tension_N >= 0.0);
                }
            }
        }
    }
    EXPECT_LE(unmet, steps / 50);
}

INSTANTIATE_TEST_SUITE_P(EveryPairOfInputs, RandomPairs, testing::Range(0, 5));

}  // namespace
}  // namespace capstan
