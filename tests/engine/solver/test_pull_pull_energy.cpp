// The power audit of the pair: over full cycles what motor and load put in is stored in the two cables and
// the load's spring or lost to friction, to 1e-9 of all work done.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

#include "capstan/solver/pull_pull.h"
#include "energy_account.h"
#include "example_cables.h"

namespace capstan {
namespace {

struct Drive {
    const char* name;
    std::function<PullPullInputs(double swing, double other_swing)> inputs;
    bool goes_slack;
};

struct PairAudit {
    test::EnergyAccount cables;
    double motor_J = 0.0;  // into the pair
    double load_J = 0.0;   // out of it: into a spring, and through it into its wall
    double spring_J = 0.0;
    double wall_J = 0.0;
    double worst_step = 0.0;  // imbalance of all work done until then
    int slack_steps = 0;

    double throughput_J() const { return cables.throughput_J; }
    double imbalance_J() const {
        return motor_J - load_J - cables.stored_J - cables.friction_J - cables.untaken_slack_J;
    }
};

PullPull pair_of_unlike_cables() {
    const Cable routed(test::routed_specification(15));
    CableSpecification bent = test::paper_specification(20);
    bent.curvature = {{2.0, 0.7}};
    bent.pretension_N = 20.0;
    return {routed, Cable(bent), {0.020, 0.104}};
}

class PullPullEnergy : public testing::TestWithParam<Drive> {};

// Torques at the middle of the step times the angles turned in it (E16); a spring's own energy and its wall.
void add_step(const PullPull& pair, const PullPullState& before, const PullPullState& after,
              const PullPullInputs& from, const PullPullInputs& to, PairAudit& audit) {
    const double motor_Nm = 0.5 * (pair.motor_torque_Nm(before) + pair.motor_torque_Nm(after));
    const double load_Nm = 0.5 * (pair.load_torque_Nm(before) + pair.load_torque_Nm(after));
    audit.motor_J += motor_Nm * (after.motor_angle_rad - before.motor_angle_rad);
    audit.load_J += load_Nm * (after.load_angle_rad - before.load_angle_rad);
    audit.cables += test::account(pair.cable_a(), before.cable_a, after.cable_a);
    audit.cables += test::account(pair.cable_b(), before.cable_b, after.cable_b);
    if (const auto* spring = std::get_if<LoadSpring>(&to.load)) {
        const double was_rad = before.load_angle_rad - std::get<LoadSpring>(from.load).wall_angle_rad;
        const double is_rad = after.load_angle_rad - spring->wall_angle_rad;
        audit.spring_J += 0.5 * spring->stiffness_Nm_per_rad * (is_rad * is_rad - was_rad * was_rad);
        audit.wall_J += load_Nm * (spring->wall_angle_rad - std::get<LoadSpring>(from.load).wall_angle_rad);
    }
}

TEST_P(PullPullEnergy, OfAFullCycleBalancesToRounding) {
    const PullPull pair = pair_of_unlike_cables();
    PullPullState state = pair.at_rest();
    constexpr int steps = 400;
    const auto inputs_at = [](int n) {
        const double angle = 2.0 * std::numbers::pi * n / steps;
        return GetParam().inputs(std::sin(angle), std::sin(2.0 * angle));
    };
    PairAudit audit;
    for (int n = 1; n <= 3 * steps; ++n) {
        const PullPullState before = state;
        const PullPullReport report = pair.advance(state, inputs_at(n));
        add_step(pair, before, state, inputs_at(n - 1), inputs_at(n), audit);
        audit.slack_steps += report.cable_a.pattern.kind == MotionKind::slack ||
                             report.cable_b.pattern.kind == MotionKind::slack;
        audit.worst_step = std::max(audit.worst_step, std::abs(audit.imbalance_J()) / audit.throughput_J());
    }
    std::cout << "    motor " << audit.motor_J << " J = load " << audit.load_J << " + cables "
              << audit.cables.stored_J << " + friction " << audit.cables.friction_J << " + untaken slack "
              << audit.cables.untaken_slack_J << "; worst imbalance " << audit.worst_step << " of "
              << audit.throughput_J() << " J, one cable slack in " << audit.slack_steps << " steps\n";
    EXPECT_LT(audit.worst_step, 1e-9);
    EXPECT_GT(audit.cables.friction_J, 0.0);
    EXPECT_EQ(audit.slack_steps > 0, GetParam().goes_slack);
    // What the load takes is in its spring or went through it into the wall; other loads take it all.
    if (audit.spring_J != 0.0) {
        EXPECT_NEAR(audit.load_J, audit.spring_J + audit.wall_J, 1e-9 * audit.throughput_J());
    }
}

const Drive drives[] = {
    {"MotorAngleLockedLoad",
     [](double a, double) {
         return PullPullInputs{MotorAngle{0.2 * a}, LoadAngle{}};
     },
     false},
    {"MotorAngleHandleMoved",
     [](double a, double b) {
         return PullPullInputs{MotorAngle{0.2 * a}, LoadAngle{0.03 * b}};
     },
     false},
    {"MotorAngleHandleMovedThroughSlack",
     [](double a, double b) {
         return PullPullInputs{MotorAngle{2.0 * a}, LoadAngle{0.1 * b}};
     },
     true},
    {"MotorAngleFreeLoad",
     [](double a, double) {
         return PullPullInputs{MotorAngle{2.0 * a}, LoadTorque{0.0}};
     },
     false},
    {"MotorAngleLoadTorque",
     [](double a, double b) {
         return PullPullInputs{MotorAngle{0.5 * a}, LoadTorque{0.5 * b}};
     },
     false},
    {"MotorAngleLoadSpring",
     [](double a, double b) {
         return PullPullInputs{MotorAngle{0.5 * a}, LoadSpring{5.0, 0.1 * b}};
     },
     false},
    {"MotorTorqueLockedLoad",
     [](double a, double) {
         return PullPullInputs{MotorTorque{0.2 * a}, LoadAngle{}};
     },
     false},
    {"MotorTorqueHandleMoved",
     [](double a, double b) {
         return PullPullInputs{MotorTorque{0.2 * a}, LoadAngle{0.03 * b}};
     },
     false},
    {"MotorTorqueThroughSlack",
     [](double a, double) {
         return PullPullInputs{MotorTorque{1.5 * a}, LoadAngle{}};
     },
     true},
    {"MotorTorqueLoadSpring",
     [](double a, double b) {
         return PullPullInputs{MotorTorque{0.2 * a}, LoadSpring{5.0, 0.1 * b}};
     },
     false},
};

INSTANTIATE_TEST_SUITE_P(EveryDrive, PullPullEnergy, testing::ValuesIn(drives),
                         [](const auto& which) { return std::string(which.param.name); });

}  // namespace
}  // namespace capstan
