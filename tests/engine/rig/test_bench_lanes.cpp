#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/rig/bench_cables_kernel.h"
#include "capstan/rig/bench_simulation.h"

namespace capstan {
namespace {

BenchDescription bench_with(double friction) {
    CableSpecification specification;
    specification.curvature = {{0.6, 5.0}, {0.8, 0.28}, {0.6, 5.0}};
    specification.segments = 30;
    specification.axial_stiffness_N = 4000.0;
    specification.dynamic_friction = specification.static_friction = friction;
    specification.pretension_N = 6.0;
    return {Cable(specification), CableArrangement::pull_pull, {0.02, 0.104}, {}};
}

BenchEffects typical(const std::string& name, const std::string& variant) {
    BenchEffects effects;
    for (const Effect& effect : effect_catalogue()) {
        if (effect.name != name || effect.variant != variant) continue;
        std::vector<double> values;
        for (const EffectParameter& parameter : effect.parameters) values.push_back(parameter.typical);
        effect.apply(effects, values);
    }
    return effects;
}

BenchInputs hand_in_lanes_at(int step) {
    const double angle = 0.3 * std::sin(2.0 * std::numbers::pi * step * 0.005);
    return {MotorTorque{-0.3 * angle}, LoadAngle{angle}, 0.005, step * 0.005};
}

// Effects of neighbouring benches (creep, a gap that Newton's method cannot close, friction that varies) do
// not change a bench's result, and neither does the width of the vectors: eight benches fill the widest, and
// one that takes longer than the others goes on in a narrow one.
TEST(BenchSimulations, ABenchIsIndependentOfItsNeighbours) {
    std::vector<BenchDescription> descriptions;
    for (const double friction : {0.21, 0.15, 0.21, 0.3, 0.1, 0.25, 0.18, 0.21})
        descriptions.push_back(bench_with(friction));
    const std::vector<BenchEffects> effects = {typical("creep", ""),
                                               typical("backlash", "load"),
                                               typical("stribeck", ""),
                                               {},
                                               typical("viscous_friction", ""),
                                               typical("inertia", "motor"),
                                               typical("presliding", ""),
                                               typical("moving_bend", "")};
    ASSERT_EQ(effects.size(), static_cast<std::size_t>(bench_lanes));
    BenchSimulations together(descriptions, effects);
    for (int bench = 0; bench < together.count(); ++bench) {
        const auto at = static_cast<std::size_t>(bench);
        BenchSimulations all(descriptions, effects);
        BenchSimulation alone(descriptions[at], effects[at]);
        for (int step = 1; step <= 300; ++step) {
            all.advance(hand_in_lanes_at(step));
            alone.advance(hand_in_lanes_at(step));
            ASSERT_EQ(all.pulleys(bench).load_torque_Nm(), alone.load_torque_Nm()) << bench << " at " << step;
            ASSERT_EQ(all.pulleys(bench).motor_angle_rad(), alone.motor_angle_rad())
                << bench << " at " << step;
            ASSERT_EQ(all.tension_at_N(bench, 1, 1.3), alone.tension_at_N(1, 1.3)) << bench << " at " << step;
        }
    }
}

TEST(BenchSimulations, ABenchHasItsOwnPulleys) {
    std::vector<BenchDescription> descriptions(2, bench_with(0.21));
    descriptions[1].pulleys = {0.03, 0.09};
    const std::vector<BenchEffects> effects = {{}, typical("eccentric_pulley", "")};
    BenchSimulations together(descriptions, effects);
    BenchSimulation first(descriptions[0], effects[0]);
    BenchSimulation second(descriptions[1], effects[1]);
    for (int step = 1; step <= 300; ++step) {
        together.advance(hand_in_lanes_at(step));
        first.advance(hand_in_lanes_at(step));
        second.advance(hand_in_lanes_at(step));
        ASSERT_EQ(together.pulleys(0).load_torque_Nm(), first.load_torque_Nm()) << step;
        ASSERT_EQ(together.pulleys(1).load_torque_Nm(), second.load_torque_Nm()) << step;
    }
    EXPECT_NE(first.load_torque_Nm(), second.load_torque_Nm());
}

// Runs of one recording move side by side.
TEST(BenchSimulations, ABenchFollowsItsOwnInputs) {
    const std::vector<BenchDescription> descriptions(2, bench_with(0.21));
    const std::vector<BenchEffects> effects = {typical("pretension_drift", ""), {}};
    BenchSimulations together(descriptions, effects);
    BenchSimulation first(descriptions[0], effects[0]);
    BenchSimulation second(descriptions[1], effects[1]);
    for (int step = 1; step <= 300; ++step) {
        const BenchInputs of_first = hand_in_lanes_at(step);
        const BenchInputs of_second = {MotorAngle{0.01 * step}, LoadTorque{0.2}, 0.005, 100.0 + step * 0.005};
        together.advance(std::vector<BenchInputs>{of_first, of_second});
        first.advance(of_first);
        second.advance(of_second);
        ASSERT_EQ(together.pulleys(0).load_torque_Nm(), first.load_torque_Nm()) << step;
        ASSERT_EQ(together.pulleys(1).load_angle_rad(), second.load_angle_rad()) << step;
        ASSERT_EQ(together.pulleys(1).motor_torque_Nm(), second.motor_torque_Nm()) << step;
    }
}

// Where time itself moves a cable: creep, drag, a friction that follows the speed.
TEST(BenchSimulations, ABenchHasItsOwnTimeSteps) {
    for (const char* effect : {"creep", "viscous_friction", "stribeck"}) {
        const std::vector<BenchDescription> descriptions(2, bench_with(0.21));
        const std::vector<BenchEffects> effects(2, typical(effect, ""));
        BenchSimulations together(descriptions, effects);
        BenchSimulation quick(descriptions[0], effects[0]);
        BenchSimulation slow(descriptions[1], effects[1]);
        for (int step = 1; step <= 300; ++step) {
            const BenchInputs of_quick = hand_in_lanes_at(step);
            BenchInputs of_slow = of_quick;
            of_slow.time_step_s *= step % 3 == 0 ? 10.0 : 4.0;
            together.advance(std::vector<BenchInputs>{of_quick, of_slow});
            quick.advance(of_quick);
            slow.advance(of_slow);
            ASSERT_EQ(together.pulleys(0).load_torque_Nm(), quick.load_torque_Nm()) << effect << step;
            ASSERT_EQ(together.pulleys(1).load_torque_Nm(), slow.load_torque_Nm()) << effect << step;
        }
        EXPECT_NE(quick.load_torque_Nm(), slow.load_torque_Nm()) << effect;
    }
}

TEST(BenchSimulations, InputsThatDoNotFitAreRefusedAndNothingMoves) {
    const std::vector<BenchDescription> descriptions(2, bench_with(0.21));
    BenchSimulations benches(descriptions, std::vector<BenchEffects>(2));
    BenchInputs endless = hand_in_lanes_at(40);
    endless.time_step_s = 0.0;
    EXPECT_THROW(benches.advance(std::vector<BenchInputs>{hand_in_lanes_at(40), endless}), InvalidInput);
    EXPECT_THROW(benches.advance(std::vector<BenchInputs>{hand_in_lanes_at(40)}), InvalidInput);
    EXPECT_EQ(benches.pulleys(0).load_angle_rad(), 0.0);
}

// A fit stops a bench that does not converge, so that it costs nothing more.
TEST(BenchSimulations, AStoppedBenchStaysWhereItIsAndItsNeighboursGoOn) {
    const std::vector<BenchDescription> descriptions = {bench_with(0.21), bench_with(0.15), bench_with(0.21)};
    const std::vector<BenchEffects> effects = {{}, typical("stribeck", ""), {}};
    BenchSimulations all(descriptions, effects);
    BenchSimulations without(descriptions, effects);
    constexpr int stopped = 1;
    double tension_N = 0.0;
    for (int step = 1; step <= 200; ++step) {
        if (step == 101) {
            without.stop(stopped);
            tension_N = without.tension_at_N(stopped, 0, 1.3);
        }
        all.advance(hand_in_lanes_at(step));
        const auto reports = without.advance(hand_in_lanes_at(step));
        ASSERT_EQ(reports[stopped].converged, step <= 100) << step;
        for (const int neighbour : {0, 2}) {
            ASSERT_TRUE(reports[static_cast<std::size_t>(neighbour)].converged) << step;
            ASSERT_EQ(all.pulleys(neighbour).load_torque_Nm(), without.pulleys(neighbour).load_torque_Nm())
                << step;
            ASSERT_EQ(all.tension_at_N(neighbour, 1, 1.3), without.tension_at_N(neighbour, 1, 1.3)) << step;
        }
    }
    EXPECT_EQ(without.tension_at_N(stopped, 0, 1.3), tension_N);
    EXPECT_NE(all.tension_at_N(stopped, 0, 1.3), tension_N);
}

// A rotor on two locked cables rings at sqrt(k / J), and Newmark's method keeps it ringing.
TEST(BenchSimulations, AnUnmodelledRotorOscillates) {
    BenchDescription description = bench_with(1e-4);
    BenchEffects effects;
    effects.of<Inertia>().motor_kg_m2 = 1e-3;
    BenchSimulation bench(description, effects);
    constexpr double step_s = 0.001;
    std::vector<double> angle_rad;
    for (int step = 1; step <= 1000; ++step) {
        bench.advance({MotorTorque{0.02}, LoadAngle{0.0}, step_s, 0.0});
        angle_rad.push_back(bench.motor_angle_rad());
    }
    const double stiffness_Nm_per_rad = 2.0 * 4000.0 / 2.0 * 0.02 * 0.02;  // two cables of EA / L
    const double rest_rad = 0.02 / stiffness_Nm_per_rad;
    int crossings = 0;
    for (std::size_t k = 1; k < angle_rad.size(); ++k)
        crossings += (angle_rad[k - 1] - rest_rad) * (angle_rad[k] - rest_rad) < 0.0 ? 1 : 0;
    const double expected = std::sqrt(stiffness_Nm_per_rad / 1e-3) / std::numbers::pi;  // in one second
    EXPECT_NEAR(crossings, expected, 1.5);
}

}  // namespace
}  // namespace capstan
