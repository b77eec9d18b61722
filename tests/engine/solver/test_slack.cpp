#include <gtest/gtest.h>

#include <cmath>

#include "example_cables.h"
#include "trajectories.h"

namespace capstan {
namespace {

class Slack : public testing::Test {
  protected:
    void move_proximal_end_to(double displacement_m) {
        report =
            step.advance(state, {EndCondition::position_m(displacement_m), EndCondition::position_m(0.0)});
    }

    Cable cable = test::paper_cable(10);
    QuasiStaticStep step{cable, ModelRules::consistent()};
    CableState state = pretensioned(cable);
    StepReport report;
};

TEST_F(Slack, BeginsWhereTheEndDistanceEqualsTheUnstretchedLength) {
    move_proximal_end_to(-1e-6);
    EXPECT_NE(report.pattern.kind, MotionKind::slack);
    EXPECT_GT(state.tension_N.front(), 0.0);
    move_proximal_end_to(1e-6);
    EXPECT_EQ(report.pattern.kind, MotionKind::slack);
    for (const double tension_N : state.tension_N) EXPECT_EQ(tension_N, 0.0);
    EXPECT_EQ(state.displacement_m.front(), 1e-6);
    EXPECT_EQ(state.displacement_m.back(), 0.0);
}

TEST_F(Slack, CarriesNothingUntilTautAgain) {
    for (const double displacement_m : {0.002, 0.005, 0.001, 1e-9}) {
        move_proximal_end_to(displacement_m);
        EXPECT_EQ(report.pattern.kind, MotionKind::slack);
        EXPECT_EQ(state.tension_N.back(), 0.0);
    }
}

TEST_F(Slack, StaysSlackWhileNothingMoves) {
    move_proximal_end_to(0.002);
    const CableState hanging = state;
    move_proximal_end_to(0.002);
    EXPECT_EQ(report.pattern.kind, MotionKind::slack) << "at rest, but carrying nothing";
    EXPECT_EQ(state.displacement_m, hanging.displacement_m);
}

TEST_F(Slack, ErasesFrictionHistory) {
    move_proximal_end_to(0.003);
    move_proximal_end_to(-0.002);  // taut again: everything slides, as if never moved before
    EXPECT_TRUE(report.verified);
    EXPECT_EQ(report.pattern.kind, MotionKind::mass);
    const double ratio = std::exp(-0.21 * 0.2 / 0.28);
    for (int i = 0; i < cable.segments(); ++i) {
        EXPECT_NEAR(state.tension_N[i + 1] / state.tension_N[i], ratio, 1e-12);
    }
}

TEST_F(Slack, AZeroTensionInputLeavesTheCableJustUnstretched) {
    const StepReport released =
        step.advance(state, {EndCondition::tension_N(0.0), EndCondition::position_m(0.0)});
    EXPECT_EQ(released.pattern.kind, MotionKind::slack);
    EXPECT_DOUBLE_EQ(state.displacement_m.front(), 0.0);
}

TEST_F(Slack, ASlackCableRelaxesItsSpring) {
    const StepReport released =
        step.advance(state, {EndCondition::position_m(0.05), distal_spring({500.0, 10.0, 0.0})});
    EXPECT_EQ(released.pattern.kind, MotionKind::slack);
    EXPECT_NEAR(state.displacement_m.back(), 10.0 / 500.0, 1e-15);
}

TEST_F(Slack, CyclesThroughSlackStayFinite) {
    for (const EndConditions& ends : test::sine_against_locked_end(cable, 0.02, 200, 2000)) {
        const StepReport passed = step.advance(state, ends);
        EXPECT_TRUE(passed.verified);
        for (const double tension_N : state.tension_N) {
            ASSERT_TRUE(std::isfinite(tension_N));
            ASSERT_GE(tension_N, 0.0);
        }
    }
}

}  // namespace
}  // namespace capstan
