// What turns a bench's motor and what its load meets: each input, and what can lie between it and the pulley.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/rig/bench_simulation.h"
#include "example_bench.h"

namespace capstan {
namespace {

using namespace test;

BenchSimulation pair_with(const BenchEffects& effects, double friction = 0.21) {
    return {{cable_with(30, friction), CableArrangement::pull_pull, pulleys, {}}, effects};
}

double swing(int step) {
    return std::sin(2.0 * std::numbers::pi * step / 200.0);
}

// Whether the bench's description states it or an effect adds it.
TEST(MotorInertia, TakesTorqueFromAMotorWhoseAngleIsGiven) {
    constexpr double inertia_kg_m2 = 1e-3;
    BenchDescription described{cable_with(30), CableArrangement::pull_pull, pulleys, {}};
    BenchSimulation without(described, {});
    BenchEffects effects;
    effects.of<Inertia>().motor_kg_m2 = inertia_kg_m2;
    BenchSimulation added(described, effects);
    described.inertia.motor_kg_m2 = inertia_kg_m2;
    BenchSimulation stated(described, {});
    for (int step = 1; step <= 200; ++step) {
        const BenchInputs inputs = {MotorAngle{0.2 * swing(step)}, LoadAngle{0.0}, time_step_s, 0.0};
        for (BenchSimulation* bench : {&without, &stated, &added}) bench->advance(inputs);
        const double changed = step == 1 ? swing(1) : swing(step) - 2.0 * swing(step - 1) + swing(step - 2);
        const double taken_Nm = inertia_kg_m2 * 0.2 * changed / (time_step_s * time_step_s);
        ASSERT_NEAR(stated.motor_torque_Nm() - without.motor_torque_Nm(), taken_Nm, 1e-9) << step;
        ASSERT_NEAR(added.motor_torque_Nm() - without.motor_torque_Nm(), taken_Nm, 1e-9) << step;
    }
}

// How far the rotor still rings, half a second after its torque set in.
double rings_rad(double decay_per_s) {
    BenchEffects effects;
    effects.of<Inertia>() = {.motor_kg_m2 = 1e-3, .motor_decay_per_s = decay_per_s};
    BenchSimulation bench = pair_with(effects, 0.01);
    double low = 1.0;
    double high = -1.0;
    for (int step = 1; step <= 200; ++step) {
        bench.advance({MotorTorque{0.1}, LoadAngle{0.0}, time_step_s, 0.0});
        if (step <= 100) continue;
        low = std::min(low, bench.motor_angle_rad());
        high = std::max(high, bench.motor_angle_rad());
    }
    return high - low;
}

TEST(MotorInertia, RingsOnItsCablesUntilDampingStopsIt) {
    EXPECT_GT(rings_rad(0.0), 5e-3);
    EXPECT_LT(rings_rad(5.0), 0.5 * rings_rad(0.0));
    EXPECT_LT(rings_rad(20.0), 0.1 * rings_rad(0.0));
}

// Closed form: without effects it is the pull-pull pair.

class EveryLoad : public testing::TestWithParam<int> {};

PullPullInputs driven(int drive, int step) {
    switch (drive) {
        case 0:
            return {MotorAngle{swing(step)}, LoadSpring{3.0, 0.1 * swing(3 * step)}};
        case 1:
            return {MotorAngle{swing(step)}, LoadTorque{0.2 * swing(3 * step)}};
        default:
            return {MotorTorque{0.2 * swing(step)}, LoadSpring{3.0, 0.1 * swing(3 * step)}};
    }
}

TEST_P(EveryLoad, WithoutEffectsTheBenchIsThePullPullPair) {
    const Cable cable = cable_with(100);
    const PullPull pair(cable, cable, pulleys);
    PullPullState state = pair.at_rest();
    BenchSimulation bench({cable, CableArrangement::pull_pull, pulleys, {}}, {});
    double torque_squares = 0.0;
    double angle_squares = 0.0;
    constexpr int steps = 400;
    for (int step = 1; step <= steps; ++step) {
        const PullPullInputs inputs = driven(GetParam(), step);
        pair.advance(state, inputs);
        ASSERT_TRUE(bench.advance({inputs.motor, inputs.load, time_step_s, 0.0}).converged) << step;
        torque_squares += std::pow(bench.load_torque_Nm() - pair.load_torque_Nm(state), 2);
        angle_squares += std::pow(bench.load_angle_rad() - state.load_angle_rad, 2);
    }
    EXPECT_LT(std::sqrt(torque_squares / steps), 0.01);  // of 0.4 N m
    EXPECT_LT(std::sqrt(angle_squares / steps), 1e-3);   // of 0.15 rad
}

INSTANTIATE_TEST_SUITE_P(SpringTorqueAndTorqueAgainstSpring, EveryLoad, testing::Range(0, 3));

TEST(SingleCable, MotorTorqueIsItsTensionTimesTheRadius) {
    BenchSimulation bench({cable_with(30), CableArrangement::single, pulleys, {}}, {});
    for (int step = 1; step <= 200; ++step) {
        const double torque_Nm = pulleys.motor_radius_m * (8.0 + 4.0 * swing(step));
        ASSERT_TRUE(bench.advance({MotorTorque{torque_Nm}, LoadAngle{0.0}, time_step_s, 0.0}).converged);
        EXPECT_NEAR(bench.motor_tension_N(0), torque_Nm / pulleys.motor_radius_m, 1e-4) << step;
    }
}

TEST(SingleCable, CannotHoldAMotorThatPushes) {
    BenchSimulation bench({cable_with(30), CableArrangement::single, pulleys, {}}, {});
    const BenchReport report = bench.advance({MotorTorque{-0.5}, LoadAngle{0.0}, time_step_s, 0.0});
    EXPECT_FALSE(report.converged);
    EXPECT_TRUE(std::isfinite(bench.motor_angle_rad()));
}

TEST(BenchSimulation, RefusesPulleysWithoutARadius) {
    EXPECT_THROW(BenchSimulation({cable_with(30), CableArrangement::pull_pull, {0.0, 0.104}, {}}, {}),
                 InvalidInput);
    EXPECT_THROW(BenchSimulation({cable_with(30), CableArrangement::single, {0.02, -0.104}, {}}, {}),
                 InvalidInput);
}

// Lost motion.

TEST(MotorBacklash, TransmitsNothingWithinItsGap) {
    BenchEffects effects;
    effects.of<Backlash>().motor_half_gap_rad = 0.05;
    BenchSimulation bench = pair_with(effects);
    for (int step = 1; step <= 200; ++step) {
        bench.advance({MotorAngle{0.045 * swing(step)}, LoadAngle{0.0}, time_step_s, 0.0});
        ASSERT_NEAR(bench.load_torque_Nm(), 0.0, 1e-6) << step;
        ASSERT_NEAR(bench.motor_torque_Nm(), 0.0, 1e-6) << step;
    }
}

TEST(MotorBacklash, BeyondTheGapEqualsAMotorWithoutBacklashShiftedByTheGap) {
    BenchEffects effects;
    effects.of<Backlash>().motor_half_gap_rad = 0.05;
    for (const double way : {1.0, -1.0}) {
        BenchSimulation with = pair_with(effects);
        BenchSimulation without = pair_with({});
        for (int step = 1; step <= 100; ++step) {
            const double turned_rad = way * 0.01 * step;
            with.advance({MotorAngle{turned_rad + way * 0.05}, LoadAngle{0.0}, time_step_s, 0.0});
            without.advance({MotorAngle{turned_rad}, LoadAngle{0.0}, time_step_s, 0.0});
            ASSERT_NEAR(with.motor_torque_Nm(), without.motor_torque_Nm(), 1e-3) << way << " at " << step;
            ASSERT_NEAR(with.load_torque_Nm(), without.load_torque_Nm(), 1e-3) << way << " at " << step;
        }
        EXPECT_GT(way * without.motor_torque_Nm(), 0.1);
    }
}

// A cable only pulls, so that its pulley rests on one side of the gap wherever it turns. The contact gives
// way by less than 0.1 mrad, which changes the torque by less than 1 mN m.
TEST(MotorBacklash, IsNotCrossedByASingleCable) {
    BenchEffects effects;
    effects.of<Backlash>().motor_half_gap_rad = 0.05;
    const BenchDescription single = {cable_with(30), CableArrangement::single, pulleys, {}};
    BenchSimulation with(single, effects);
    BenchSimulation without(single, {});
    for (int step = 1; step <= 400; ++step) {
        const double turned_rad = 0.3 * swing(step);
        with.advance({MotorAngle{turned_rad + 0.05}, LoadAngle{0.0}, time_step_s, 0.0});
        without.advance({MotorAngle{turned_rad}, LoadAngle{0.0}, time_step_s, 0.0});
        ASSERT_NEAR(with.motor_torque_Nm(), without.motor_torque_Nm(), 1e-3) << step;
        ASSERT_NEAR(with.load_torque_Nm(), without.load_torque_Nm(), 1e-3) << step;
    }
}

TEST(LoadBacklash, BeyondTheGapEqualsALoadWithoutBacklashShiftedByTheGap) {
    BenchEffects effects;
    effects.of<Backlash>().load_half_gap_rad = 0.02;
    for (const double way : {1.0, -1.0}) {
        BenchSimulation with = pair_with(effects);
        BenchSimulation without = pair_with({});
        for (int step = 1; step <= 60; ++step) {
            const double turned_rad = way * 0.002 * step;
            with.advance({MotorAngle{0.0}, LoadAngle{turned_rad + way * 0.02}, time_step_s, 0.0});
            without.advance({MotorAngle{0.0}, LoadAngle{turned_rad}, time_step_s, 0.0});
            // Of 4.5 N m; the contact gives a little.
            ASSERT_NEAR(with.load_torque_Nm(), without.load_torque_Nm(), 0.03) << way << " at " << step;
        }
        EXPECT_LT(way * without.load_torque_Nm(), -0.3);
    }
}

// Where contact opens and closes Newton's method goes to and fro, and the load's angle is closed in on
// instead.
TEST(LoadBacklash, AHandleThatCrossesItsGapCarriesTheCableTorque) {
    BenchEffects effects;
    effects.of<Backlash>().load_half_gap_rad = 0.01;
    BenchSimulation bench = pair_with(effects);
    int max_iterations = 0;
    for (int step = 1; step <= 200; ++step) {
        const BenchReport report =
            bench.advance({MotorAngle{0.0}, LoadAngle{0.3 * swing(step)}, time_step_s, 0.0});
        ASSERT_TRUE(report.converged) << step;
        max_iterations = std::max(max_iterations, report.iterations);
        const double pulled_Nm = pulleys.load_radius_m * (bench.load_tension_N(0) - bench.load_tension_N(1));
        // Of 13 N m; the pulley's own inertia takes the rest.
        ASSERT_NEAR(pulled_Nm, bench.load_torque_Nm(), 5e-3) << step;
    }
    EXPECT_GT(max_iterations, 60) << "no step was hard";
}

// The hand moves a third of a radian in a step: some steps are not met and say so, the others are balanced.
TEST(LoadBacklash, ASolvedStepIsBalanced) {
    BenchEffects effects;
    effects.of<Backlash>().load_half_gap_rad = 0.05;
    BenchSimulation bench = pair_with(effects);
    int solved = 0;
    for (int step = 1; step <= 400; ++step) {
        const bool converged =
            bench.advance({MotorAngle{0.0}, LoadAngle{1.0 * swing(10 * step)}, 10 * time_step_s, 0.0})
                .converged;
        if (!converged) continue;
        ++solved;
        const double pulled_Nm = pulleys.load_radius_m * (bench.load_tension_N(0) - bench.load_tension_N(1));
        EXPECT_NEAR(pulled_Nm, bench.load_torque_Nm(), 5e-3) << step;
    }
    EXPECT_GT(solved, 300);
}

// A motor that is turned from outside.

TEST(TurnedMotor, GivesItsInertiaItsAcceleration) {
    BenchEffects effects;
    effects.of<Inertia>().motor_kg_m2 = 2e-3;
    BenchSimulation heavy = pair_with(effects);
    BenchSimulation light = pair_with({});
    constexpr double acceleration_rad_per_s2 = 5.0;
    for (int step = 1; step <= 40; ++step) {
        const double time_s = step * time_step_s;
        const BenchInputs inputs{MotorAngle{0.5 * acceleration_rad_per_s2 * time_s * time_s}, LoadAngle{0.0},
                                 time_step_s, time_s};
        heavy.advance(inputs);
        light.advance(inputs);
        if (step == 1) continue;  // out of rest: half of it in one step
        ASSERT_NEAR(heavy.motor_torque_Nm() - light.motor_torque_Nm(), 2e-3 * acceleration_rad_per_s2, 1e-9)
            << step;
    }
}

TEST(TurnedMotor, GivesItsBearingsFrictionWhileItTurnsAndNothingAtRest) {
    BenchEffects effects;
    effects.of<PulleyFriction>().motor.coulomb_Nm = 0.05;
    BenchSimulation dragging = pair_with(effects);
    BenchSimulation free = pair_with({});
    const auto lost_Nm = [&](double angle_rad) {
        const BenchInputs inputs{MotorAngle{angle_rad}, LoadAngle{0.0}, time_step_s, 0.0};
        dragging.advance(inputs);
        free.advance(inputs);
        return dragging.motor_torque_Nm() - free.motor_torque_Nm();
    };
    for (int step = 1; step <= 20; ++step) ASSERT_NEAR(lost_Nm(0.01 * step), 0.05, 1e-9);
    for (int step = 19; step >= 0; --step) ASSERT_NEAR(lost_Nm(0.01 * step), -0.05, 1e-9);
    EXPECT_NEAR(lost_Nm(0.0), 0.0, 1e-12);
}

// Bristles hold where a sign of the speed could not.
TEST(TurnedMotor, OnABearingWithPreslidingIsHeldAtRestToo) {
    BenchEffects effects;
    effects.of<PulleyFriction>().motor.coulomb_Nm = 0.05;
    effects.of<PulleyFriction>().motor.presliding_rad = 1e-3;
    BenchSimulation dragging = pair_with(effects);
    BenchSimulation free = pair_with({});
    for (int step = 1; step <= 40; ++step) {
        const BenchInputs inputs{MotorAngle{0.01 * std::min(step, 20)}, LoadAngle{0.0}, time_step_s, 0.0};
        dragging.advance(inputs);
        free.advance(inputs);
        ASSERT_NEAR(dragging.motor_torque_Nm() - free.motor_torque_Nm(), 0.05, 1e-9) << step;
    }
}

TEST(TurnedMotor, OnAGearGivesAPartMoreThanTheCablesTakeAndGetsAPartLessBack) {
    constexpr double part = 0.1;
    BenchEffects effects;
    effects.of<PulleyFriction>().motor.per_torque = part;
    BenchSimulation geared = pair_with(effects);
    BenchSimulation free = pair_with({});
    const auto ratio = [&](double angle_rad) {
        const BenchInputs inputs{MotorAngle{angle_rad}, LoadAngle{0.0}, time_step_s, 0.0};
        geared.advance(inputs);
        free.advance(inputs);
        return geared.motor_torque_Nm() / free.motor_torque_Nm();
    };
    for (int step = 1; step <= 40; ++step) ASSERT_NEAR(ratio(0.01 * step), 1.0 + part, 1e-6) << step;
    for (int step = 39; step >= 20; --step) ASSERT_NEAR(ratio(0.01 * step), 1.0 - part, 1e-6) << step;
    EXPECT_NEAR(ratio(0.2), 1.0, 1e-9);  // at rest
}

TEST(TurnedLoad, OnAGearPassesAPartLessOfTheCablesTorqueToTheHandThatYields) {
    constexpr double part = 0.1;
    BenchEffects effects;
    effects.of<PulleyFriction>().load.per_torque = part;
    BenchSimulation geared = pair_with(effects);
    BenchSimulation free = pair_with({});
    // The motor pulls first, while the load is held, and the hand then moves with it and against it.
    double load_rad = 0.0;
    const auto ratio = [&](int step, double by_rad) {
        load_rad += by_rad;
        const BenchInputs inputs{MotorAngle{0.02 * std::min(step, 40)}, LoadAngle{load_rad}, time_step_s,
                                 0.0};
        geared.advance(inputs);
        free.advance(inputs);
        return geared.load_torque_Nm() / free.load_torque_Nm();
    };
    int step = 0;
    while (step < 60) EXPECT_NEAR(ratio(++step, 0.0), 1.0, 1e-9) << step;
    while (step < 70) ASSERT_NEAR(ratio(++step, 0.001), 1.0 - part, 1e-6) << step;
    while (step < 80) ASSERT_NEAR(ratio(++step, -0.001), 1.0 + part, 1e-6) << step;
}

// The two pulleys find their angles; what the gear takes depends on what the cables pull, which is sought
// too.
TEST(DrivenMotor, ThroughAGearPullsTheCablesWithWhatItLeaves) {
    constexpr double part = 0.2;
    BenchEffects effects;
    effects.of<PulleyFriction>().motor.per_torque = part;
    BenchSimulation bench = pair_with(effects);
    for (int step = 1; step <= 200; ++step) {
        const double torque_Nm = 0.2 * swing(step);
        const double before_rad = bench.motor_angle_rad();
        ASSERT_TRUE(bench.advance({MotorTorque{torque_Nm}, LoadSpring{3.0, 0.0}, time_step_s, 0.0}).converged)
            << step;
        const double pull_Nm = pulleys.motor_radius_m * (bench.motor_tension_N(0) - bench.motor_tension_N(1));
        const double turned_rad = bench.motor_angle_rad() - before_rad;
        ASSERT_LE(std::abs(torque_Nm - pull_Nm), part * std::abs(pull_Nm) + 1e-7) << step;
        if (std::abs(turned_rad) < 1e-3) continue;  // the friction is not built up
        ASSERT_NEAR(torque_Nm, pull_Nm + std::copysign(part * std::abs(pull_Nm), turned_rad), 1e-6) << step;
    }
}

// Friction by what the cable does.

BenchSimulation cable_held_at_its_end(const BenchEffects& effects, double friction) {
    return {{cable_with(30, friction), CableArrangement::single, pulleys, {}}, effects};
}

// From rest the cable slides one way only, as that of a bench with the friction of this way.
TEST(DirectionalFriction, IsThatOfTheWayThatTheCableSlides) {
    constexpr double friction = 0.21;
    constexpr double difference = 0.3;
    BenchEffects effects;
    effects.of<DirectionalFriction>().difference = difference;
    for (const double way : {1.0, -1.0}) {  // the motor pulls the cable in, or lets it out
        BenchSimulation directional = cable_held_at_its_end(effects, friction);
        BenchSimulation same = cable_held_at_its_end({}, friction * (1.0 - way * difference));
        for (int step = 1; step <= 40; ++step) {
            const BenchInputs inputs{MotorAngle{way * 0.005 * step}, LoadAngle{0.0}, time_step_s, 0.0};
            directional.advance(inputs);
            same.advance(inputs);
        }
        EXPECT_NEAR(directional.load_tension_N(0), same.load_tension_N(0), 2e-3) << way;
        EXPECT_NEAR(directional.motor_tension_N(0), same.motor_tension_N(0), 2e-3) << way;
    }
}

TEST(FrictionDrift, EndsAtTheFrictionThatItSettlesAt) {
    constexpr double friction = 0.21;
    BenchEffects effects;
    effects.of<FrictionDrift>() = {.change = 0.5, .settling_s = 2.0};
    const auto torque_Nm = [&](const BenchEffects& with, double its_friction, double session_time_s) {
        BenchSimulation bench = pair_with(with, its_friction);
        for (int step = 1; step <= 40; ++step)
            bench.advance({MotorAngle{0.01 * step}, LoadAngle{0.0}, time_step_s, session_time_s});
        return bench.load_torque_Nm();
    };
    const double early_Nm = torque_Nm(effects, friction, 0.0);
    const double late_Nm = torque_Nm(effects, friction, 200.0);
    EXPECT_NEAR(early_Nm, torque_Nm({}, friction, 0.0), 1e-9);
    EXPECT_NEAR(late_Nm, torque_Nm({}, 1.5 * friction, 200.0), 1e-6);
    EXPECT_LT(late_Nm, 0.95 * early_Nm);
}

// How much of the cable slides.

// Where it reels in as much as a round pulley, the cables cannot tell the two apart, and its torque is that
// of the round one times the ratio of the radii.
TEST(EccentricPulley, PullsLikeARoundOneThatReelsInAsMuch) {
    BenchEffects effects;
    effects.of<EccentricPulley>() = {0.2, -0.1, 0.05};
    BenchSimulation eccentric = pair_with(effects);
    BenchSimulation round = pair_with({});
    for (int step = 1; step <= 400; ++step) {
        const double angle_rad = 0.8 * swing(step);
        const double reeled_rad = effects.of<EccentricPulley>().reeled_rad(angle_rad);
        ASSERT_TRUE(eccentric.advance({MotorAngle{angle_rad}, LoadTorque{0.1}, time_step_s, 0.0}).converged);
        ASSERT_TRUE(round.advance({MotorAngle{reeled_rad}, LoadTorque{0.1}, time_step_s, 0.0}).converged);
        ASSERT_NEAR(eccentric.load_angle_rad(), round.load_angle_rad(), 1e-9) << step;
        ASSERT_NEAR(eccentric.motor_torque_Nm(),
                    effects.of<EccentricPulley>().radius_ratio(angle_rad) * round.motor_torque_Nm(), 1e-9)
            << step;
    }
}

// A motor that its torque turns finds the angle at which that torque would have been measured.
TEST(EccentricPulley, TurnsToWhereItsTorqueIsThatOfTheAngle) {
    BenchEffects effects;
    effects.of<EccentricPulley>() = {0.2, -0.1, 0.05};
    BenchSimulation turned = pair_with(effects);
    BenchSimulation pulled = pair_with(effects);
    for (int step = 1; step <= 400; ++step) {
        const double angle_rad = 0.3 * swing(step);
        ASSERT_TRUE(turned.advance({MotorAngle{angle_rad}, LoadAngle{0.0}, time_step_s, 0.0}).converged);
        const MotorTorque torque{turned.motor_torque_Nm()};
        ASSERT_TRUE(pulled.advance({torque, LoadAngle{0.0}, time_step_s, 0.0}).converged);
        ASSERT_NEAR(pulled.motor_angle_rad(), angle_rad, 1e-4) << step;
    }
}

TEST(SlidingFraction, IsZeroAtRestAndAllButTheHeldEndsInMassMotion) {
    const std::vector<BenchDescription> bench = {{cable_with(30), CableArrangement::pull_pull, pulleys, {}}};
    const std::vector<BenchEffects> effects(1);
    BenchSimulations simulation(bench, effects);
    EXPECT_EQ(simulation.cables().sliding_fraction(0), 0.0);
    double before = 0.0;
    for (int step = 1; step <= 100; ++step) {
        simulation.advance({MotorAngle{0.02 * step}, LoadAngle{0.0}, time_step_s, 0.0});
        const double fraction = simulation.cables().sliding_fraction(0);
        ASSERT_GE(fraction, before) << "a front that goes on one way does not come back";
        before = fraction;
    }
    EXPECT_DOUBLE_EQ(before, 60.0 / 62.0);
}

}  // namespace
}  // namespace capstan
