#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "capstan/gap_trial/lumped_cable.h"

namespace capstan::gap_trial {
namespace {

constexpr int masses = 60;

LumpedCableNumbers bent_cable(double friction) {
    LumpedCableNumbers numbers;
    numbers.curvature = {{2.0, 0.7}};
    numbers.axial_stiffness_N = 4000.0;
    numbers.mass_kg_per_m = 0.006;
    numbers.dynamic_friction = numbers.static_friction = friction;
    numbers.pretension_N = 20.0;
    return numbers;
}

// Pulls the load end away slowly and evenly, the motor end held.
CableEnds slowly_pulled(double time_s) {
    constexpr double speed_m_per_s = 0.01;
    return {0.0, 0.0, speed_m_per_s * time_s, speed_m_per_s};
}

void pull_for(LumpedCable& cable, double time_s, double step_s) {
    const int steps = static_cast<int>(time_s / step_s);
    for (int k = 1; k <= steps; ++k) cable.step(slowly_pulled(k * step_s));
}

TEST(LumpedCable, SlidingTensionFollowsTheCapstanEquation) {
    LumpedCableNumbers numbers = bent_cable(0.21);
    numbers.damping_s = 1e-5;
    const double step_s = LumpedCable::stable_time_step_s(numbers, masses);
    LumpedCable cable(numbers, {}, masses, step_s);
    pull_for(cable, 1.0, step_s);
    const double wrap_rad = 2.0 / 0.7;
    EXPECT_NEAR(cable.load_tension_N() / cable.motor_tension_N(), std::exp(0.21 * wrap_rad), 2e-3);
    EXPECT_NEAR(cable.tension_N(1.0) / cable.motor_tension_N(), std::exp(0.105 * wrap_rad), 2e-3);
}

// dT/ds = k T + c v, k the friction of the bend by length and v rising evenly from the held end: the drag
// adds to friction of the bend and does not change it. A step that takes the drag off before friction misses
// this by 3 N; the cable's waves, by less than 0.1 N.
TEST(LumpedCable, ViscousDragAddsToTheFrictionOfBends) {
    constexpr double drag_N_s_per_m2 = 26.0;
    LumpedCableNumbers numbers = bent_cable(0.21);
    numbers.damping_s = 1e-5;
    const double step_s = LumpedCable::stable_time_step_s(numbers, masses);
    const double exponent = 0.21 * 2.0 / 0.7;
    const double of_drag_N =
        drag_N_s_per_m2 * 0.01 / 2.0 * (std::expm1(exponent) - exponent) / std::pow(exponent / 2.0, 2);
    for (const double one_way : {0.0, 1e-6}) {  // friction by direction has a step of its own
        TrueEffects effects;
        effects.viscous_drag_N_s_per_m2 = drag_N_s_per_m2;
        effects.one_way_friction = one_way;
        LumpedCable cable(numbers, effects, masses, step_s);
        pull_for(cable, 1.0, step_s);
        EXPECT_NEAR(cable.load_tension_N(), cable.motor_tension_N() * std::exp(exponent) + of_drag_N, 0.1);
    }
}

TEST(LumpedCable, WithoutFrictionItIsASpring) {
    LumpedCableNumbers numbers = bent_cable(0.0);
    numbers.damping_s = 1e-4;
    const double step_s = 0.2 * LumpedCable::stable_time_step_s(numbers, masses);
    LumpedCable cable(numbers, {}, masses, step_s);
    pull_for(cable, 0.5, step_s);
    const double stretched_N = 20.0 + 4000.0 / 2.0 * 0.01 * 0.5;
    EXPECT_NEAR(cable.motor_tension_N(), stretched_N, 0.1);
    EXPECT_NEAR(cable.load_tension_N(), stretched_N, 0.1);
}

// An end pulled at a speed v sends a tension v sqrt(EA m') along the cable; a held end doubles it.
TEST(LumpedCable, AWaveArrivesInItsTimeAndIsDoubledByAHeldEnd) {
    LumpedCableNumbers numbers = bent_cable(0.0);
    numbers.damping_s = 1e-5;
    const double step_s = LumpedCable::stable_time_step_s(numbers, masses);
    LumpedCable cable(numbers, {}, masses, step_s);
    const double transit_s = 2.0 / std::sqrt(4000.0 / 0.006);
    constexpr double speed_m_per_s = 0.5;
    double time_s = 0.0;
    const auto pull_until = [&](double end_s) {
        for (; time_s < end_s; time_s += step_s)
            cable.step({0.0, 0.0, speed_m_per_s * time_s, speed_m_per_s});
    };
    pull_until(0.8 * transit_s);
    EXPECT_NEAR(cable.motor_tension_N(), 20.0, 0.05);
    EXPECT_NEAR(cable.load_tension_N(), 20.0 + speed_m_per_s * std::sqrt(4000.0 * 0.006), 0.1);
    pull_until(1.5 * transit_s);
    EXPECT_NEAR(cable.motor_tension_N(), 20.0 + 2.0 * speed_m_per_s * std::sqrt(4000.0 * 0.006), 0.3);
}

TEST(LumpedCable, KeepsItsEnergyWithoutFrictionAndLosesItWith) {
    for (const double friction : {0.0, 0.21}) {
        const LumpedCableNumbers numbers = bent_cable(friction);
        const double step_s = 0.2 * LumpedCable::stable_time_step_s(numbers, masses);
        LumpedCable cable(numbers, {}, masses, step_s);
        // Struck at one end, then both ends held.
        const double blow_s = 0.01;
        CableEnds ends;
        for (double time_s = 0.0; time_s < blow_s; time_s += step_s) {
            ends.load_m = 1e-3 * std::sin(0.5 * std::numbers::pi * time_s / blow_s);
            cable.step(ends);
        }
        const double struck_J = cable.energy_J(ends);
        for (int k = 0; k < 20000; ++k) cable.step(ends);
        if (friction == 0.0) {
            EXPECT_NEAR(cable.energy_J(ends), struck_J, 0.01 * std::abs(struck_J));
        } else {
            EXPECT_LT(cable.energy_J(ends), struck_J);
        }
    }
}

TEST(LumpedCable, ASlackCableCarriesNothing) {
    const LumpedCableNumbers numbers = bent_cable(0.21);
    const double step_s = LumpedCable::stable_time_step_s(numbers, masses);
    LumpedCable cable(numbers, {}, masses, step_s);
    for (int k = 0; k < 20000; ++k) cable.step({0.0, 0.0, -1e-6 * std::min(k, 15000), 0.0});
    EXPECT_LT(cable.load_tension_N(), 1e-6);
    EXPECT_GE(cable.tension_N(1.0), 0.0);
}

}  // namespace
}  // namespace capstan::gap_trial
