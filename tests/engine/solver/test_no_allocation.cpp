// Once its state exists, a step asks for no memory, whatever the motion.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "allocation_count.h"
#include "capstan/solver/pull_pull.h"
#include "example_cables.h"
#include "trajectories.h"

namespace capstan {
namespace {

using KindCounts = std::array<int, 5>;  // steps of each MotionKind

// Kinds seen, and allocations while stepping.
struct Walked {
    KindCounts kinds{};
    long allocations = 0;
};

Walked walk(double step_m, double slack_m, const ModelRules& rules) {
    const Cable cable = test::paper_cable(10);
    const QuasiStaticStep step(cable, rules);
    CableState state = pretensioned(cable);
    const CableState rest = state;
    const auto path = test::both_ends_wander(2000, step_m, 3);
    Walked walked;
    const long before = test::allocations();
    for (const auto& [proximal_m, distal_m] : path) {
        const StepReport report =
            step.advance(state, {EndCondition::position_m(rest.displacement_m.front() + proximal_m + slack_m),
                                 EndCondition::position_m(distal_m)});
        ++walked.kinds[static_cast<std::size_t>(report.pattern.kind)];
    }
    walked.allocations = test::allocations() - before;
    return walked;
}

TEST(NoAllocation, TheCounterCounts) {
    const long before = test::allocations();
    const auto number = std::make_unique<double>(1.0);
    const std::vector<double> numbers(100, *number);
    EXPECT_EQ(test::allocations() - before, 2);
    EXPECT_EQ(numbers.back(), 1.0);
}

TEST(NoAllocation, InAStepOfAnyMotion) {
    KindCounts kinds{};
    for (const double step_m : {1e-4, 1e-3}) {
        for (const double slack_m : {0.0, 0.012}) {
            for (const ModelRules& rules : {ModelRules::consistent(), ModelRules::paper()}) {
                const Walked walked = walk(step_m, slack_m, rules);
                EXPECT_EQ(walked.allocations, 0);
                for (std::size_t kind = 0; kind < kinds.size(); ++kind) kinds[kind] += walked.kinds[kind];
            }
        }
    }
    for (const MotionKind kind :
         {MotionKind::partial, MotionKind::mass, MotionKind::opposed, MotionKind::slack}) {
        EXPECT_GT(kinds[static_cast<std::size_t>(kind)], 0) << static_cast<int>(kind);
    }
}

TEST(NoAllocation, InAStepOfThePullPullPairWithAWorkspaceGiven) {
    const Cable cable = test::paper_cable(10);
    const PullPull pair(cable, cable, {0.02, 0.02});
    PullPullState state = pair.at_rest();
    PullPullState workspace = state;
    const auto inputs = [](int n) -> std::array<PullPullInputs, 3> {
        const double swing = std::sin(0.05 * n);
        return {{{MotorAngle{0.3 * swing}, LoadAngle{0.1 * swing}},
                 {MotorTorque{0.1 * swing}, LoadAngle{0.0}},
                 {MotorAngle{0.3 * swing}, LoadSpring{0.5, 0.0}}}};
    };
    const long before = test::allocations();
    for (int n = 0; n < 300; ++n) {
        for (const PullPullInputs& input : inputs(n)) pair.advance(state, input, workspace);
    }
    EXPECT_EQ(test::allocations() - before, 0);
}

}  // namespace
}  // namespace capstan
