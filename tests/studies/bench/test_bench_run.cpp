#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/bench/bench_run.h"
#include "capstan/cable/invalid_input.h"

namespace capstan::bench {
namespace {

Waveform sine(double amplitude, double frequency_Hz) {
    Waveform wave;
    wave.kind = WaveformKind::sines;
    wave.amplitudes = {amplitude};
    wave.frequency_Hz = {frequency_Hz};
    wave.phase_rad = {0.0};
    return wave;
}

// A motor angle to and fro, load locked.
BenchPlan plan_with(double pretension_N, double motor_amplitude_rad) {
    BenchPlan plan;
    plan.cable.curvature = {{2.0, 0.7}};
    plan.cable.segments = 40;
    plan.cable.axial_stiffness_N = 2000.0;
    plan.cable.dynamic_friction = plan.cable.static_friction = 0.21;
    plan.cable.pretension_N = pretension_N;
    plan.pulleys = {0.02, 0.104};
    plan.motor_drive = MotorDrive::angle;
    plan.motor = sine(motor_amplitude_rad, 0.5);
    plan.sample_rate_Hz = 200.0;
    plan.duration_s = 3.0;
    return plan;
}

std::vector<BenchInstant> run(const BenchPlan& plan) {
    std::vector<BenchInstant> instants;
    simulate_bench(plan, [&](const BenchInstant& now) { instants.push_back(now); });
    return instants;
}

double most(const std::vector<double>& tension_N) {
    return *std::max_element(tension_N.begin(), tension_N.end());
}

TEST(BenchRun, BeginsAtRestAndLastsItsDuration) {
    const auto instants = run(plan_with(5.0, 0.3));
    ASSERT_EQ(instants.size(), 601u);
    EXPECT_EQ(instants.front().load_torque_Nm, 0.0);
    EXPECT_EQ(instants.front().tension_a_N, std::vector<double>(41, 5.0));
    EXPECT_DOUBLE_EQ(instants.back().time_s, 3.0);
    for (const BenchInstant& now : instants) EXPECT_TRUE(now.solved) << now.time_s;
}

TEST(BenchRun, TorquesAreThoseOfTheTensionsAtThePulleys) {
    for (const BenchInstant& now : run(plan_with(5.0, 0.3))) {
        EXPECT_NEAR(now.motor_torque_Nm, 0.02 * (now.tension_a_N.front() - now.tension_b_N.front()), 1e-12);
        EXPECT_NEAR(now.load_torque_Nm, 0.104 * (now.tension_a_N.back() - now.tension_b_N.back()), 1e-12);
    }
}

// 1 rad of the motor pulley is 20 mm; 2 N of pretension stretch 2 m by 2 mm.
TEST(BenchRun, WhileOneCablePullsTheOtherGoesSlackAndComesBack) {
    BenchPlan plan = plan_with(2.0, 1.0);
    plan.load_kind = LoadKind::spring;
    plan.load_stiffness_Nm_per_rad = 12.0;
    int a_slack = 0;
    int b_slack = 0;
    for (const BenchInstant& now : run(plan)) {
        const bool a = most(now.tension_a_N) == 0.0;
        const bool b = most(now.tension_b_N) == 0.0;
        EXPECT_FALSE(a && b) << "one always pulls, at " << now.time_s;
        if (b) {
            EXPECT_GT(now.load_torque_Nm, -1e-12) << "only A is left to pull";
        }
        if (a) {
            EXPECT_LT(now.load_torque_Nm, 1e-12);
        }
        a_slack += a;
        b_slack += b;
    }
    EXPECT_GT(a_slack, 50);
    EXPECT_GT(b_slack, 50);
}

TEST(BenchRun, AFreeLoadHasNoTorque) {
    BenchPlan plan = plan_with(5.0, 0.3);
    plan.load_kind = LoadKind::torque;
    for (const BenchInstant& now : run(plan)) EXPECT_NEAR(now.load_torque_Nm, 0.0, 1e-6) << now.time_s;
}

TEST(BenchRun, AnEffectSwitchesToTheSimulationThatHasIt) {
    BenchPlan plan = plan_with(5.0, 0.3);
    plan.load_kind = LoadKind::handle;
    plan.load = sine(0.1, 0.5);
    const auto ideal = run(plan);
    const auto& effects = effect_catalogue();
    const auto viscous = std::find_if(effects.begin(), effects.end(),
                                      [](const Effect& effect) { return effect.name == "viscous_friction"; });
    std::vector<double>& drag = plan.effects[static_cast<std::size_t>(viscous - effects.begin())];
    // So little that only the simulation itself could make a difference.
    drag[0] = 1e-6;
    EXPECT_EQ(effects_there(plan.effects), std::vector<std::string>{"viscous_friction"});
    const auto little_friction = run(plan);
    drag[0] = 20.0;
    const auto much = run(plan);
    ASSERT_EQ(ideal.size(), little_friction.size());
    double apart_Nm = 0.0;
    double dragged_Nm = 0.0;
    for (std::size_t k = 0; k < ideal.size(); ++k) {
        apart_Nm = std::max(apart_Nm, std::abs(ideal[k].load_torque_Nm - little_friction[k].load_torque_Nm));
        dragged_Nm = std::max(dragged_Nm, std::abs(ideal[k].load_torque_Nm - much[k].load_torque_Nm));
    }
    EXPECT_LT(apart_Nm, 0.05) << "the discretisation, of a peak of 1 N m";
    EXPECT_GT(dragged_Nm, 2.0 * apart_Nm);
    EXPECT_EQ(much.front().tension_a_N.size(), 41u);
}

TEST(BenchRun, TorqueAtBothPulleysIsRefused) {
    BenchPlan plan = plan_with(5.0, 0.3);
    plan.motor_drive = MotorDrive::torque;
    plan.load_kind = LoadKind::torque;
    EXPECT_THROW(run(plan), InvalidInput);
}

}  // namespace
}  // namespace capstan::bench
