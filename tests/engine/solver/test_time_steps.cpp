// What the length of a time step does to the answer, and with which order it goes away.
//
// A node at rest remembers the state in which it stopped; a sliding node follows from its end and from the
// first node at rest (E1-E3), not from its own past. So the past acts only through profiles left behind by
// fronts that turned:
// - no turn: no error at all, whatever the step;
// - one driven end: the turning point falls between two samples, and a smooth path misses its own turning
//   value by the square of the step: order 2, or no error where a sample hits every turning point;
// - both ends driven against each other with no node at rest: the zero-velocity point (E7) is where the
//   velocities of one step say, so each step depends on the one before: order 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "convergence_order.h"
#include "example_cables.h"
#include "sampled_path.h"

namespace capstan {
namespace {

constexpr int finest_steps_per_instant = 4096;
constexpr std::array steps_per_instant{1, 2, 4, 8, 16, 32, 64, 128};

Cable cable_with_stiction(double static_friction) {
    CableSpecification specification = test::paper_specification(40);
    specification.static_friction = static_friction;
    return Cable(specification);
}

// Samples away from turning points; 60 instants to 1.25 cycles would hit them.
test::SampledPath sampled(test::EndMotion (*motion)(double)) {
    return {motion, 48};
}

test::ErrorsByHalving errors_of(const test::SampledPath& path, const Cable& cable) {
    const auto finest = path.states(cable, finest_steps_per_instant);
    test::ErrorsByHalving errors;
    for (const int steps : steps_per_instant)
        errors.add(test::mean_difference_N(path.states(cable, steps), finest));
    return errors;
}

class TimeSteps : public testing::TestWithParam<double> {};  // mu_s

TEST_P(TimeSteps, DoNotMatterWithoutTurningPoints) {
    const Cable cable = cable_with_stiction(GetParam());
    const test::SampledPath pull = sampled(test::pulled);
    const auto coarse = pull.states(cable, 1);
    const auto fine = pull.states(cable, 1000);
    EXPECT_LT(test::mean_difference_N(coarse, fine), 1e-12);
}

TEST_P(TimeSteps, DoNotMatterWhereASampleHitsEveryTurningPoint) {
    const Cable cable = cable_with_stiction(GetParam());
    const test::SampledPath cycle{test::one_end_cycles, 60};
    EXPECT_LT(test::mean_difference_N(cycle.states(cable, 1), cycle.states(cable, 1000)), 1e-12);
}

TEST_P(TimeSteps, MissATurningPointByTheSquareOfTheirLength) {
    const auto errors = errors_of(sampled(test::one_end_cycles), cable_with_stiction(GetParam()));
    errors.tell("one end driven, mean error [N]");
    EXPECT_NEAR(errors.mean_order(), 2.0, 0.2);
    EXPECT_GT(std::ranges::min(errors.orders()), 1.3);
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithStiction, TimeSteps, testing::Values(0.21, 0.63),
                         [](const auto& which) { return which.param > 0.21 ? "Stiction" : "NoStiction"; });

TEST(TimeSteps, ConvergeWithOrderOneWhereBothEndsSlideAgainstEachOther) {
    const auto errors = errors_of(sampled(test::both_ends_cycle), cable_with_stiction(0.21));
    errors.tell("both ends driven, mean error [N]");
    EXPECT_NEAR(errors.mean_order(), 1.0, 0.1);
    EXPECT_GT(std::ranges::min(errors.orders()), 0.8);
}

// A front held by stiction gives way at an instant; samples beside it differ by the complete jump until the
// instant is met, so only the mean over instants converges, and less evenly.
TEST(TimeSteps, ConvergeWithStictionTooInTheMeanOverInstants) {
    const auto errors = errors_of(sampled(test::both_ends_cycle), cable_with_stiction(0.63));
    errors.tell("both ends driven with stiction, mean error [N]");
    EXPECT_GT(errors.mean_order(), 0.6);
}

}  // namespace
}  // namespace capstan
