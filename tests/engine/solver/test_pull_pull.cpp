// Two cables against each other on two pulleys: what the pair must do whatever its cables do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/pull_pull.h"
#include "example_cables.h"

namespace capstan {
namespace {

constexpr Pulleys papers_pulleys{0.020, 0.104};  // Table I
constexpr double ratio = papers_pulleys.load_radius_m / papers_pulleys.motor_radius_m;

CableSpecification gentle_specification(double pretension_N, double static_friction = 0.21) {
    CableSpecification specification = test::paper_specification(20);
    specification.curvature = {{2.0, 0.7}};  // 2.86 rad
    specification.static_friction = static_friction;
    specification.pretension_N = pretension_N;
    return specification;
}

PullPull gentle_pair(double pretension_N, double static_friction = 0.21) {
    const Cable cable(gentle_specification(pretension_N, static_friction));
    return {cable, cable, papers_pulleys};
}

PullPull frictionless_pair() {
    CableSpecification specification = gentle_specification(10.0);
    specification.dynamic_friction = 0.0;
    specification.static_friction = 0.0;
    const Cable cable(specification);
    return {cable, cable, papers_pulleys};
}

// From rest through both extremes and back, smooth.
double swing(int sample) {
    return std::sin(2.0 * std::numbers::pi * sample / 200.0);
}

constexpr LoadAngle locked{0.0};

// Closed form: without friction the pair is its pulleys.

TEST(PullPull, WithoutFrictionALockedLoadFeelsTheMotorTorqueTimesTheRatio) {
    const PullPull pair = frictionless_pair();
    PullPullState state = pair.at_rest();
    for (int n = 1; n <= 400; ++n) {
        const double torque_Nm = 0.125 * swing(n);
        const PullPullReport report = pair.advance(state, {MotorTorque{torque_Nm}, locked});
        EXPECT_TRUE(report.solved());
        EXPECT_NEAR(pair.motor_torque_Nm(state), torque_Nm, torque_tolerance_Nm);
        EXPECT_NEAR(pair.load_torque_Nm(state), ratio * torque_Nm, ratio * torque_tolerance_Nm);
    }
}

TEST(PullPull, WithoutFrictionAFreeLoadTurnsWithTheMotorOverTheRatio) {
    const PullPull pair = frictionless_pair();
    PullPullState state = pair.at_rest();
    for (int n = 1; n <= 400; ++n) {
        const double angle_rad = 2.0 * swing(n);
        EXPECT_TRUE(pair.advance(state, {MotorAngle{angle_rad}, LoadTorque{0.0}}).solved());
        EXPECT_NEAR(state.load_angle_rad, angle_rad / ratio, 1e-10);
    }
}

TEST(PullPull, WithoutFrictionASpringAndTheCablesAreSpringsInARow) {
    const PullPull pair = frictionless_pair();
    PullPullState state = pair.at_rest();
    const LoadSpring spring{5.0, 0.02};
    const double cables_Nm_per_rad =  // two cables, EA / L each, seen from the load
        2.0 * 2000.0 / 2.0 * papers_pulleys.load_radius_m * papers_pulleys.load_radius_m;
    for (int n = 1; n <= 100; ++n) {
        const double angle_rad = 0.2 * swing(n);
        EXPECT_TRUE(pair.advance(state, {MotorAngle{angle_rad}, spring}).solved());
        const double in_a_row_Nm_per_rad = 5.0 * cables_Nm_per_rad / (5.0 + cables_Nm_per_rad);
        EXPECT_NEAR(pair.load_torque_Nm(state), in_a_row_Nm_per_rad * (angle_rad / ratio - 0.02), 1e-9);
    }
}

TEST(PullPull, WithoutFrictionTheLoadFeelsTheIdealTorque) {
    const PullPull pair = frictionless_pair();
    PullPullState state = pair.at_rest();
    for (int n = 1; n <= 100; ++n) {
        pair.advance(state, {MotorAngle{0.2 * swing(n)}, LoadAngle{0.03 * swing(3 * n)}});
        EXPECT_NEAR(pair.load_torque_Nm(state), pair.ideal_load_torque_Nm(pair.motor_torque_Nm(state)), 1e-9);
    }
}

// Torques are then straight lines of the angle, whose slopes a search can tell from the stiffest end and
// spring.
TEST(PullPull, WithoutFrictionFourTrialsMeetATorque) {
    const PullPull pair = frictionless_pair();
    const auto expect_few = [&](const PullPullInputs& inputs, AngleSearch PullPullReport::*searched) {
        PullPullState state = pair.at_rest();
        const PullPullReport report = pair.advance(state, inputs);
        EXPECT_TRUE(report.solved());
        EXPECT_GT((report.*searched).iterations, 1);
        EXPECT_LE((report.*searched).iterations, 4);
    };
    expect_few({MotorTorque{0.1}, locked}, &PullPullReport::motor);
    expect_few({MotorAngle{0.0}, LoadTorque{0.1}}, &PullPullReport::load);
    for (const double stiffness_Nm_per_rad : {1.0, 100.0, 1e5})
        expect_few({MotorAngle{0.0}, LoadSpring{stiffness_Nm_per_rad, 1e-3}}, &PullPullReport::load);
}

TEST(PullPull, MeetsALoadTorque) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    for (int n = 1; n <= 100; ++n) {
        const double torque_Nm = 0.2 * swing(5 * n);
        const PullPullReport report =
            pair.advance(state, {MotorAngle{0.5 * swing(n)}, LoadTorque{torque_Nm}});
        EXPECT_TRUE(report.solved()) << n;
        EXPECT_NEAR(pair.load_torque_Nm(state), torque_Nm, torque_tolerance_Nm) << n;
    }
}

// A prescribed angle needs no search.
TEST(PullPull, PrescribedAnglesNeedNoTrial) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    const PullPullReport report = pair.advance(state, {MotorAngle{0.1}, LoadAngle{0.01}});
    EXPECT_TRUE(report.solved());
    for (const AngleSearch& search : {report.motor, report.load}) {
        EXPECT_EQ(search.iterations, 0);
        EXPECT_FALSE(search.at_jump);
    }
}

TEST(PullPull, IsSolvedOnlyIfBothCablesAndBothAnglesAre) {
    EXPECT_TRUE(PullPullReport{}.solved());
    for (int missing = 0; missing < 4; ++missing) {
        PullPullReport report;
        report.cable_a.verified = missing != 0;
        report.cable_b.verified = missing != 1;
        report.motor.converged = missing != 2;
        report.load.converged = missing != 3;
        EXPECT_FALSE(report.solved()) << missing;
        for (StepReport* cable : {&report.cable_a, &report.cable_b}) cable->verified = false;
        EXPECT_FALSE(report.solved()) << missing;
        for (AngleSearch* search : {&report.motor, &report.load}) search->converged = false;
        EXPECT_FALSE(report.solved()) << missing;
    }
}

TEST(PullPull, MotorTorqueAgainstASpringHoldsBothBalances) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    for (int n = 1; n <= 400; ++n) {
        const LoadSpring handle{2.0, 0.2 * swing(2 * n)};
        const double torque_Nm = 0.1 * swing(n);
        const PullPullReport report = pair.advance(state, {MotorTorque{torque_Nm}, handle});
        EXPECT_TRUE(report.solved()) << n;
        EXPECT_NEAR(pair.motor_torque_Nm(state), torque_Nm, torque_tolerance_Nm) << n;
        EXPECT_NEAR(pair.load_torque_Nm(state), 2.0 * (state.load_angle_rad - handle.wall_angle_rad),
                    torque_tolerance_Nm)
            << n;
    }
}

// Laws.

TEST(PullPull, StartsInBalance) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    EXPECT_EQ(pair.motor_torque_Nm(state), 0.0);
    const PullPullReport report = pair.advance(state, {MotorTorque{0.0}, locked});
    EXPECT_EQ(report.motor.iterations, 1);
    EXPECT_EQ(report.cable_a.pattern.kind, MotionKind::rest);
    EXPECT_EQ(state.motor_angle_rad, 0.0);
}

TEST(PullPull, PositiveMotorAngleTightensCableAAtTheMotor) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    pair.advance(state, {MotorAngle{0.02}, locked});
    EXPECT_GT(state.cable_a.tension_N.front(), 5.0);
    EXPECT_LT(state.cable_b.tension_N.front(), 5.0);
    EXPECT_GT(pair.motor_torque_Nm(state), 0.0);
}

TEST(PullPull, ALoadTurnedItsPositiveWayIsHeldBack) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    pair.advance(state, {MotorAngle{0.0}, LoadAngle{0.01}});
    EXPECT_LT(pair.load_torque_Nm(state), 0.0);
}

TEST(PullPull, SwappingTheCablesAndTheSignsMirrorsTheAnswer) {
    const Cable one(test::routed_specification(15));
    const Cable other(gentle_specification(20.0, 0.3));
    const PullPull pair(one, other, papers_pulleys);
    const PullPull mirrored(other, one, papers_pulleys);
    PullPullState state = pair.at_rest();
    PullPullState image = mirrored.at_rest();
    for (int n = 1; n <= 400; ++n) {
        const double torque_Nm = 0.3 * swing(n);
        const double angle_rad = 0.05 * swing(3 * n);
        pair.advance(state, {MotorTorque{torque_Nm}, LoadAngle{angle_rad}});
        mirrored.advance(image, {MotorTorque{-torque_Nm}, LoadAngle{-angle_rad}});
        ASSERT_DOUBLE_EQ(state.motor_angle_rad, -image.motor_angle_rad) << n;
        ASSERT_DOUBLE_EQ(pair.load_torque_Nm(state), -mirrored.load_torque_Nm(image)) << n;
        ASSERT_EQ(state.cable_a.tension_N, image.cable_b.tension_N) << n;
    }
}

// On the way up friction keeps torque from the load; on the way down it keeps it at the load.
TEST(PullPull, FrictionTakesFromARisingTorqueAndHoldsAFallingOne) {
    const PullPull pair = gentle_pair(3.0);
    PullPullState state = pair.at_rest();
    double torque_Nm = 0.0;
    for (; torque_Nm < 0.125; torque_Nm += 0.0005) {
        pair.advance(state, {MotorTorque{torque_Nm}, locked});
        ASSERT_LE(pair.load_torque_Nm(state), ratio * torque_Nm + 1e-9);
    }
    const double highest_Nm = pair.load_torque_Nm(state);
    EXPECT_GT(highest_Nm, 0.0);
    for (; torque_Nm > 0.0; torque_Nm -= 0.0005) pair.advance(state, {MotorTorque{torque_Nm}, locked});
    EXPECT_GT(pair.load_torque_Nm(state), 0.0) << "the motor pulls nothing, the load still feels it";
    EXPECT_LE(pair.load_torque_Nm(state), highest_Nm + 1e-9);
}

// All works, seen from outside over a closed cycle, leave as friction.
TEST(PullPull, AClosedCycleTakesWorkFromItsEnds) {
    const PullPull pair = gentle_pair(5.0, 0.63);
    PullPullState state = pair.at_rest();
    double work_J = 0.0;
    for (int n = 1; n <= 600; ++n) {
        const PullPullState before = state;
        pair.advance(state, {MotorAngle{0.5 * swing(n)}, LoadAngle{0.1 * swing(n + 30) - 0.1 * swing(30)}});
        if (n <= 200) continue;  // settles
        work_J += 0.5 * (pair.motor_torque_Nm(before) + pair.motor_torque_Nm(state)) *
                      (state.motor_angle_rad - before.motor_angle_rad) -
                  0.5 * (pair.load_torque_Nm(before) + pair.load_torque_Nm(state)) *
                      (state.load_angle_rad - before.load_angle_rad);
    }
    EXPECT_GT(work_J, 1e-3);
}

class SameTrajectory : public testing::TestWithParam<double> {};  // highest motor angle [rad]

// Without stiction and with the load locked the torque rises with the angle, so the way back is unique.
TEST_P(SameTrajectory, DrivenByItsAngleOrByTheTorqueThatCameOfIt) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState by_angle = pair.at_rest();
    PullPullState by_torque = pair.at_rest();
    for (int n = 1; n <= 500; ++n) {
        pair.advance(by_angle, {MotorAngle{GetParam() * swing(n)}, locked});
        const PullPullReport report =
            pair.advance(by_torque, {MotorTorque{pair.motor_torque_Nm(by_angle)}, locked});
        ASSERT_TRUE(report.motor.converged) << n;
        ASSERT_NEAR(by_torque.motor_angle_rad, by_angle.motor_angle_rad, 1e-8) << n;
        ASSERT_NEAR(pair.load_torque_Nm(by_torque), pair.load_torque_Nm(by_angle), 1e-7) << n;
    }
}

// With the handle moving, the motor pulley's own reversal shifts the torque by up to what friction takes
// from one segment, so two angles can give the same torque: the trajectories agree to that much.
TEST_P(SameTrajectory, WithAMovingHandleToTheFrictionOfOneSegment) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState by_angle = pair.at_rest();
    PullPullState by_torque = pair.at_rest();
    for (int n = 1; n <= 500; ++n) {
        const LoadAngle handle{0.03 * swing(2 * n)};
        pair.advance(by_angle, {MotorAngle{GetParam() * swing(n)}, handle});
        const PullPullReport report =
            pair.advance(by_torque, {MotorTorque{pair.motor_torque_Nm(by_angle)}, handle});
        ASSERT_TRUE(report.motor.converged) << n;
        const double tension_N =
            std::max(by_angle.cable_a.tension_N.back(), by_angle.cable_b.tension_N.back());
        const double one_segment_N = 2.0 * tension_N * std::expm1(0.21 * 0.1 / 0.7);
        ASSERT_NEAR(pair.load_torque_Nm(by_torque), pair.load_torque_Nm(by_angle),
                    papers_pulleys.load_radius_m * one_segment_N)
            << n;
    }
}

INSTANTIATE_TEST_SUITE_P(BeforeAndInSlack, SameTrajectory, testing::Values(0.05, 0.3, 1.5));

TEST(PullPull, OneCableGoesSlackWhileTheOtherPullsAndComesBack) {
    const PullPull pair = gentle_pair(3.0, 0.63);
    PullPullState state = pair.at_rest();
    bool b_was_slack = false;
    bool a_was_slack = false;
    for (int n = 1; n <= 400; ++n) {
        const double torque_Nm = 1.0 * swing(n);
        const PullPullReport report = pair.advance(state, {MotorTorque{torque_Nm}, locked});
        ASSERT_TRUE(report.motor.converged) << n;
        ASSERT_NEAR(pair.motor_torque_Nm(state), torque_Nm, torque_tolerance_Nm) << n;
        const bool a_slack = report.cable_a.pattern.kind == MotionKind::slack;
        const bool b_slack = report.cable_b.pattern.kind == MotionKind::slack;
        ASSERT_FALSE(a_slack && b_slack) << n;
        if (b_slack) {  // the other carries all
            EXPECT_NEAR(state.cable_a.tension_N.front(), torque_Nm / papers_pulleys.motor_radius_m, 1e-7);
        }
        a_was_slack = a_was_slack || a_slack;
        b_was_slack = b_was_slack || b_slack;
    }
    EXPECT_TRUE(a_was_slack);
    EXPECT_TRUE(b_was_slack);
    EXPECT_GT(state.cable_a.tension_N.front(), 0.0);
    EXPECT_GT(state.cable_b.tension_N.front(), 0.0);
}

TEST(PullPull, StictionsJumpsAreSearchedThrough) {
    const PullPull pair = gentle_pair(5.0, 0.63);
    PullPullState state = pair.at_rest();
    for (int n = 1; n <= 2000; ++n) {
        const PullPullReport report =
            pair.advance(state, {MotorTorque{0.125 * swing(n)}, LoadAngle{0.1 * swing(3 * n)}});
        ASSERT_TRUE(report.motor.converged) << n << " residual " << report.motor.torque_residual_Nm;
        ASSERT_LT(report.motor.iterations, 60) << n;
    }
}

// At the door.

TEST(PullPull, RefusesTorqueWithTorqueByName) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    try {
        pair.advance(state, {MotorTorque{0.1}, LoadTorque{0.1}});
        FAIL() << "not refused";
    } catch (const InvalidInput& refused) {
        EXPECT_NE(std::string(refused.what()).find("a torque is prescribed at both pulleys"),
                  std::string::npos);
    }
}

TEST(PullPull, RejectsInputsThatAreNotFiniteByNameAndKeepsTheState) {
    const PullPull pair = gentle_pair(5.0);
    PullPullState state = pair.at_rest();
    pair.advance(state, {MotorAngle{0.1}, locked});
    const PullPullState before = state;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    struct Bad {
        PullPullInputs inputs;
        std::string named;
    };
    const std::vector<Bad> all = {{{MotorAngle{nan}, locked}, "motor angle"},
                                  {{MotorTorque{infinity}, locked}, "motor torque"},
                                  {{MotorAngle{0.0}, LoadAngle{nan}}, "load angle"},
                                  {{MotorAngle{0.0}, LoadTorque{-infinity}}, "load torque"},
                                  {{MotorAngle{0.0}, LoadSpring{nan}}, "load spring's stiffness"},
                                  {{MotorAngle{0.0}, LoadSpring{1.0, nan}}, "wall angle"},
                                  {{MotorTorque{0.0}, LoadSpring{0.0}}, "load spring's stiffness"}};
    for (const Bad& bad : all) {
        try {
            pair.advance(state, bad.inputs);
            FAIL() << bad.named << " not refused";
        } catch (const InvalidInput& refused) {
            EXPECT_NE(std::string(refused.what()).find(bad.named), std::string::npos) << refused.what();
        }
    }
    EXPECT_EQ(state.cable_a.tension_N, before.cable_a.tension_N);
    EXPECT_EQ(state.motor_angle_rad, before.motor_angle_rad);
}

TEST(PullPull, RefusesPulleysWithoutARadius) {
    const Cable cable = test::paper_cable(4);
    EXPECT_THROW(PullPull(cable, cable, {0.0, 0.1}), InvalidInput);
    EXPECT_THROW(PullPull(cable, cable, {0.02, std::nan("")}), InvalidInput);
}

}  // namespace
}  // namespace capstan
