#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "capstan/cable/invalid_input.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/rig/bench_simulation.h"
#include "example_bench.h"

namespace capstan {
namespace {

using namespace test;

// A hand that moves the handle to and fro against a motor torque that pushes it back.
BenchInputs hand_at(int step) {
    const double time_s = step * time_step_s;
    const double angle = 0.3 * std::sin(2.0 * std::numbers::pi * time_s) * std::min(1.0, 4.0 * time_s);
    return {MotorTorque{-0.3 * angle}, LoadAngle{angle}, time_step_s, time_s};
}

struct Track {
    std::vector<double> motor_angle_rad;
    std::vector<double> load_torque_Nm;
    int not_converged = 0;

    friend bool operator==(const Track&, const Track&) = default;
};

Track track_of(BenchSimulation& bench, int steps) {
    Track track;
    for (int step = 1; step <= steps; ++step) {
        if (!bench.advance(hand_at(step)).converged) ++track.not_converged;
        track.motor_angle_rad.push_back(bench.motor_angle_rad());
        track.load_torque_Nm.push_back(bench.load_torque_Nm());
    }
    return track;
}

Track with_effects(const BenchEffects& effects, int steps = 400) {
    BenchSimulation bench({cable_with(50), CableArrangement::pull_pull, pulleys, {}}, effects);
    return track_of(bench, steps);
}

std::vector<double> typical(const Effect& effect, double severity) {
    std::vector<double> values;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        values.push_back(effect.absent[k] + severity * (effect.parameters[k].typical - effect.absent[k]));
    return values;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

// Both pulleys find their angles, and at every return of the hand fronts begin in both cables. A search that
// swings between two of their states needs thousands of iterations a step, or fails.
TEST(BenchSimulation, AMotorTorqueAndACompliantCouplingAreSolvedWhereTheHandReturns) {
    constexpr int steps = 1000;
    constexpr double coarse_step_s = 0.01;
    CableSpecification specification;
    specification.curvature = {{2.39, 0.247}};
    specification.segments = 50;
    specification.axial_stiffness_N = 2000.0;
    specification.dynamic_friction = specification.static_friction = 0.09;
    specification.pretension_N = 18.0;
    BenchEffects effects;
    effects.of<EnvironmentCoupling>().compliance_rad_per_Nm = 1e-3;
    effects.of<PulleyFriction>().motor.coulomb_Nm = 0.004;
    BenchSimulation bench({Cable(specification), CableArrangement::pull_pull, {0.0141, 0.0786}, {}}, effects);
    long iterations = 0;
    int not_converged = 0;
    for (int step = 1; step <= steps; ++step) {
        const double time_s = step * coarse_step_s;
        const auto wave = [&](double frequency_Hz) {
            return std::sin(2.0 * std::numbers::pi * frequency_Hz * time_s);
        };
        const double angle = std::min(1.0, 4.0 * time_s) * (0.2 * wave(0.43) + 0.1 * wave(1.1));
        const double torque_Nm = -0.6 * angle - 0.02 * wave(0.8);
        const BenchReport report =
            bench.advance({MotorTorque{torque_Nm}, LoadAngle{angle}, coarse_step_s, time_s});
        iterations += report.iterations;
        if (!report.converged) ++not_converged;
    }
    EXPECT_LT(iterations, 200 * steps);
    EXPECT_LT(not_converged, steps / 50);
}

TEST(BenchSimulation, WithoutEffectsItIsThePullPullPair) {
    const Cable cable = cable_with(100);
    const PullPull pair(cable, cable, pulleys);
    PullPullState state = pair.at_rest();
    BenchSimulation bench({cable, CableArrangement::pull_pull, pulleys, {}}, {});
    const Track track = track_of(bench, 800);
    EXPECT_EQ(track.not_converged, 0);
    std::vector<double> torque_Nm;
    std::vector<double> angle_rad;
    for (int step = 1; step <= 800; ++step) {
        const BenchInputs inputs = hand_at(step);
        pair.advance(state, {inputs.motor, inputs.load});
        torque_Nm.push_back(pair.load_torque_Nm(state));
        angle_rad.push_back(state.motor_angle_rad);
    }
    // Load torque swings by 1.4 N m, the motor by 1.6 rad.
    EXPECT_LT(rms_difference(track.load_torque_Nm, torque_Nm), 0.01);
    EXPECT_LT(rms_difference(track.motor_angle_rad, angle_rad), 5e-4);
}

TEST(BenchSimulation, WithoutEffectsASingleCableIsTheClosedFormStep) {
    const Cable cable = cable_with(100);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    const double rest_m = state.displacement_m.front();
    BenchSimulation bench({cable, CableArrangement::single, pulleys, {}}, {});
    for (int n = 1; n <= 600; ++n) {
        const double angle = 0.3 * std::sin(2.0 * std::numbers::pi * n / 200.0);
        bench.advance({MotorAngle{angle}, LoadAngle{0.0}, time_step_s, 0.0});
        step.advance(state, {EndCondition::position_m(rest_m - pulleys.motor_radius_m * angle),
                             EndCondition::position_m(0.0)});
        EXPECT_NEAR(bench.motor_torque_Nm(), pulleys.motor_radius_m * state.tension_N.front(), 3e-3) << n;
        EXPECT_NEAR(bench.load_torque_Nm(), pulleys.load_radius_m * state.tension_N.back(), 2e-2) << n;
    }
}

// Two metres without a bend, so that nothing rubs.
Cable straight_cable(double axial_stiffness_N) {
    CableSpecification specification;
    specification.curvature = {{2.0, std::numeric_limits<double>::infinity()}};
    specification.segments = 20;
    specification.axial_stiffness_N = axial_stiffness_N;
    specification.pretension_N = 50.0;
    return Cable(specification);
}

// A cable without friction is wound up at a constant speed. What its material loses, it pulls more (E72), and
// no more once the motor stands.
TEST(BenchSimulation, AStretchedCablePullsMoreByWhatItsMaterialLoses) {
    const Cable cable = straight_cable(4000.0);
    constexpr double loss_s = 0.002;
    constexpr double speed_rad_per_s = 0.5;
    BenchSimulation lossy(
        {.cable = cable, .arrangement = CableArrangement::single, .pulleys = pulleys, .cable_loss_s = loss_s},
        {});
    BenchSimulation elastic({.cable = cable, .arrangement = CableArrangement::single, .pulleys = pulleys},
                            {});
    const double speed_m_per_s = speed_rad_per_s * pulleys.motor_radius_m;
    const double more_N = 4000.0 / 2.0 * loss_s * speed_m_per_s;
    double angle_rad = 0.0;
    for (int step = 0; step < 100; ++step) {
        angle_rad += speed_rad_per_s * time_step_s;
        const BenchInputs inputs{MotorAngle{angle_rad}, LoadAngle{0.0}, time_step_s, 0.0};
        lossy.advance(inputs);
        elastic.advance(inputs);
        EXPECT_NEAR(lossy.motor_torque_Nm() - elastic.motor_torque_Nm(), pulleys.motor_radius_m * more_N,
                    1e-6)
            << step;
    }
    lossy.advance({MotorAngle{angle_rad}, LoadAngle{0.0}, time_step_s, 0.0});
    EXPECT_NEAR(lossy.motor_torque_Nm(), elastic.motor_torque_Nm(), 1e-9);
}

// A straight cable moves to and fro as a whole, and so does the motor in its bearing. What drags them goes
// with the speed at the end of each step (E20), not with the mean of the step, which is half a step late.
TEST(BenchSimulation, AViscousDragFollowsTheSpeedAtTheEndOfAStep) {
    const Cable cable = straight_cable(1e6);
    constexpr double drag_N_s_per_m2 = 30.0;
    constexpr double bearing_Nm_s = 0.01;
    BenchEffects effects;
    effects.of<ViscousFriction>().drag_N_s_per_m2 = drag_N_s_per_m2;
    effects.of<PulleyFriction>().motor.viscous_Nm_s = bearing_Nm_s;
    BenchSimulation bench({.cable = cable, .arrangement = CableArrangement::single, .pulleys = pulleys},
                          effects);
    constexpr double rad_per_s = 2.0 * std::numbers::pi;
    constexpr double swing_rad = 0.5;
    constexpr double max_rad_per_s = swing_rad * rad_per_s;
    constexpr double max_drag_N = drag_N_s_per_m2 * 2.0 * pulleys.motor_radius_m * max_rad_per_s;
    // By the mean of the step both would be wrong by a sixtieth.
    constexpr double second_order = rad_per_s * rad_per_s * time_step_s * time_step_s;
    for (int step = 1; step <= 200; ++step) {
        const double time_s = step * time_step_s;
        const double angle_rad = swing_rad * (1.0 - std::cos(rad_per_s * time_s));
        const double speed_rad_per_s = max_rad_per_s * std::sin(rad_per_s * time_s);
        bench.advance({MotorAngle{angle_rad},
                       LoadAngle{angle_rad * pulleys.motor_radius_m / pulleys.load_radius_m}, time_step_s,
                       time_s});
        if (step < 3) continue;  // it starts with a jerk
        const double bearing_Nm = bearing_Nm_s * speed_rad_per_s;
        const double drag_N = (bench.motor_torque_Nm() - bearing_Nm) / pulleys.motor_radius_m -
                              bench.load_torque_Nm() / pulleys.load_radius_m;
        EXPECT_NEAR(drag_N, drag_N_s_per_m2 * 2.0 * pulleys.motor_radius_m * speed_rad_per_s,
                    second_order * (max_drag_N + bearing_Nm_s * max_rad_per_s / pulleys.motor_radius_m))
            << step;
    }
}

// The load is held and the motor pulls to and fro, ever less. A cable slides up to an end that does not move,
// so that a coarse cut gives the torque of the closed form.
TEST(BenchSimulation, SlidesUpToALoadThatIsHeld) {
    const auto cable_of = [](int segments) {
        CableSpecification specification;
        specification.curvature = {{2.0, 0.7}};
        specification.segments = segments;
        specification.axial_stiffness_N = 4000.0;
        specification.dynamic_friction = specification.static_friction = 0.21;
        specification.pretension_N = 3.0;
        return Cable(specification);
    };
    const PullPull pair(cable_of(400), cable_of(400), pulleys);
    PullPullState state = pair.at_rest();
    BenchSimulation bench(
        {.cable = cable_of(40), .pulleys = pulleys, .ends = {.load_is_held = true, .error_m = 0.0}}, {});
    BenchSimulation moved({.cable = cable_of(40), .pulleys = pulleys}, {});  // as if its load could turn
    std::vector<double> exact_Nm, torque_Nm, moved_Nm;
    for (int step = 1; step <= 1000; ++step) {
        const double motor_Nm = 0.11 * std::sin(0.03 * step) * std::exp(-0.001 * step);
        const BenchInputs inputs{MotorTorque{motor_Nm}, LoadAngle{0.0}, time_step_s, 0.0};
        EXPECT_TRUE(bench.advance(inputs).converged) << step;
        pair.advance(state, {inputs.motor, inputs.load});
        exact_Nm.push_back(pair.load_torque_Nm(state));
        torque_Nm.push_back(bench.load_torque_Nm());
        moved.advance(inputs);
        moved_Nm.push_back(moved.load_torque_Nm());
    }
    const auto [least, most] = std::minmax_element(exact_Nm.begin(), exact_Nm.end());
    EXPECT_LT(rms_difference(torque_Nm, exact_Nm), 0.012 * (*most - *least));
    EXPECT_GT(rms_difference(moved_Nm, exact_Nm), 0.03 * (*most - *least));
}

class EveryEffect : public testing::TestWithParam<Effect> {};

TEST_P(EveryEffect, AbsentIsTheBaseModelBitForBit) {
    static const Track base = with_effects({});
    BenchEffects effects;
    GetParam().apply(effects, GetParam().absent);
    EXPECT_TRUE(with_effects(effects) == base);
}

TEST_P(EveryEffect, ChangesSomethingAndStaysFinite) {
    static const Track base = with_effects({});
    for (const double severity : {1.0, 4.0}) {
        BenchEffects effects;
        GetParam().apply(effects, typical(GetParam(), severity));
        const Track track = with_effects(effects);
        EXPECT_FALSE(track == base);
        for (std::size_t step = 0; step < track.load_torque_Nm.size(); ++step) {
            ASSERT_TRUE(std::isfinite(track.load_torque_Nm[step])) << severity << " at " << step;
            ASSERT_LT(std::abs(track.load_torque_Nm[step]), 20.0) << severity << " at " << step;
            ASSERT_LT(std::abs(track.motor_angle_rad[step]), 10.0) << severity << " at " << step;
        }
    }
}

TEST_P(EveryEffect, GrowsFromNothing) {
    static const Track base = with_effects({});
    BenchEffects faint;
    GetParam().apply(faint, typical(GetParam(), 1e-4));
    BenchEffects full;
    GetParam().apply(full, typical(GetParam(), 1.0));
    EXPECT_LT(rms_difference(with_effects(faint).motor_angle_rad, base.motor_angle_rad),
              0.05 * rms_difference(with_effects(full).motor_angle_rad, base.motor_angle_rad) + 1e-5);
}

// Over complete cycles hand and motor put in at least as much work as they get back.
TEST_P(EveryEffect, DissipatesEnergy) {
    BenchEffects effects;
    GetParam().apply(effects, typical(GetParam(), 2.0));
    BenchSimulation bench({cable_with(50), CableArrangement::pull_pull, pulleys, {}}, effects);
    double work_J = 0.0;
    double motor_before_rad = 0.0;
    double load_before_Nm = 0.0;
    for (int step = 1; step <= 1000; ++step) {
        const BenchInputs inputs = hand_at(step);
        bench.advance(inputs);
        const double motor_Nm = 0.5 * (std::get<MotorTorque>(inputs.motor).torque_Nm +
                                       std::get<MotorTorque>(hand_at(step - 1).motor).torque_Nm);
        const double turned_rad = std::get<LoadAngle>(inputs.load).angle_rad -
                                  std::get<LoadAngle>(hand_at(step - 1).load).angle_rad;
        if (step > 400) {
            work_J += motor_Nm * (bench.motor_angle_rad() - motor_before_rad) -
                      0.5 * (bench.load_torque_Nm() + load_before_Nm) * turned_rad;
        }
        motor_before_rad = bench.motor_angle_rad();
        load_before_Nm = bench.load_torque_Nm();
    }
    EXPECT_GT(work_J, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::ValuesIn(effect_catalogue()),
                         [](const auto& effect) {
                             std::string name =
                                 effect.param.name +
                                 (effect.param.variant.empty() ? "" : "_" + effect.param.variant);
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name;
                         });

// A cable settles everywhere at once (E33). Where nothing turns, nothing slides, so that no friction keeps
// what is lost near the motor from reaching the load, however late in a session a run begins. A conduit that
// gives way at its ends lets the cable slide a little; without friction that changes nothing.
TEST(BenchSimulation, PretensionFallsEvenlyAlongTheCable) {
    BenchEffects effects;
    effects.of<PretensionDrift>() = {.lost_by_100_s = 0.4, .settling_s = 60.0};
    effects.of<NonlinearStiffness>() = {.toe_strain = 1e-3, .toe_tension_N = 5.0};
    BenchEffects with_compliance = effects;
    with_compliance.of<ConduitCompliance>() = {.motor_m_per_N = 1e-5, .load_m_per_N = 2e-5};
    const auto expect_even = [](const Cable& cable, const BenchEffects& present) {
        for (const auto arrangement : {CableArrangement::pull_pull, CableArrangement::single}) {
            BenchSimulation bench({cable, arrangement, pulleys, {}}, present);
            for (int step = 0; step < 50; ++step) {
                const double session_time_s = 100.0 + 2.0 * step;
                ASSERT_TRUE(
                    bench.advance({MotorAngle{0.0}, LoadAngle{0.0}, time_step_s, session_time_s}).converged);
                const double left_N =
                    cable.pretension_N() * present.of<PretensionDrift>().ratio(session_time_s);
                for (const double place : {0.05, 0.3, 0.6, 0.95})
                    EXPECT_NEAR(bench.tension_at_N(0, place * cable.length_m()), left_N, 1e-6)
                        << session_time_s;
            }
        }
    };
    expect_even(cable_with(50), effects);
    expect_even(cable_with(50, 0.0), with_compliance);
}

// A tight conduit and a stiff cable: the one that is let go falls slack, and comes back.
TEST(BenchSimulation, FollowsACableThatFallsSlack) {
    CableSpecification specification;
    specification.curvature = {{2.0, 0.28}};
    specification.axial_stiffness_N = 4000.0;
    specification.dynamic_friction = specification.static_friction = 0.21;
    specification.pretension_N = 10.0;
    BenchEffects effects;
    effects.of<BendingStiffness>().drag_N_per_m = 0.2;
    std::vector<double> load_torque_Nm[2];
    double least_N = 1e3;
    for (const int refinement : {0, 1}) {
        specification.segments = refinement == 0 ? 40 : 80;
        BenchSimulation bench({Cable(specification), CableArrangement::pull_pull, pulleys, {}}, effects);
        for (int step = 1; step <= 1600; ++step) {
            const double time_s = step * time_step_s;
            const double turns = 2.0 * std::numbers::pi * time_s;
            const double angle =
                0.35 * std::sin(0.4 * turns) * std::min(1.0, time_s) + 0.02 * std::sin(2.3 * turns);
            const BenchInputs inputs{MotorTorque{-0.6 * angle}, LoadAngle{angle}, time_step_s, time_s};
            ASSERT_TRUE(bench.advance(inputs).converged) << "step " << step;
            load_torque_Nm[refinement].push_back(bench.load_torque_Nm());
            for (const int cable : {0, 1}) least_N = std::min(least_N, bench.load_tension_N(cable));
        }
    }
    EXPECT_LT(std::abs(least_N), effects.of<BendingStiffness>().drag_N_per_m * 2.0 / 40);  // of a segment
    double largest_Nm = 0.0;
    for (const double torque_Nm : load_torque_Nm[1]) largest_Nm = std::max(largest_Nm, std::abs(torque_Nm));
    EXPECT_LT(rms_difference(load_torque_Nm[0], load_torque_Nm[1]), 0.02 * largest_Nm);
}

// A slack cable leaves no choice to the size of the steps: beyond its bending drag it holds no tension, and
// what drag holds against the motor falls to nothing at the load.
TEST(BenchSimulation, ASlackCableKeepsTheTensionThatItsBendingDragHolds) {
    constexpr double drag_N_per_m = 0.3;
    constexpr double length_m = 2.4;
    constexpr double radius_m = 0.38;
    constexpr int segments = 120;
    BenchEffects effects;
    effects.of<BendingStiffness>().drag_N_per_m = drag_N_per_m;
    for (const double friction : {1e-9, 0.17}) {
        std::vector<double> at_motor_N;
        for (const int steps : {1, 10, 1000}) {
            const CableSpecification specification{.curvature = {{length_m, radius_m}},
                                                   .segments = segments,
                                                   .axial_stiffness_N = 3100.0,
                                                   .dynamic_friction = friction,
                                                   .static_friction = friction,
                                                   .pretension_N = 6.0};
            BenchSimulation bench({Cable(specification), CableArrangement::single, pulleys, {}}, effects);
            double time_s = 0.0;
            double motor_rad = 0.0;
            double load_rad = 0.0;
            const auto move_to = [&](double to_motor_rad, double to_load_rad) {
                const double from_motor_rad = std::exchange(motor_rad, to_motor_rad);
                const double from_load_rad = std::exchange(load_rad, to_load_rad);
                for (int step = 1; step <= steps; ++step) {
                    time_s += time_step_s;
                    const double done = static_cast<double>(step) / steps;
                    const MotorAngle motor{from_motor_rad + done * (to_motor_rad - from_motor_rad)};
                    const LoadAngle load{from_load_rad + done * (to_load_rad - from_load_rad)};
                    ASSERT_TRUE(bench.advance({motor, load, time_step_s, time_s}).converged);
                }
            };
            for (const auto& [motor, load] :
                 {std::pair{0.0, -0.2}, {0.0, -0.1}, {-0.5, -0.1}, {-0.5, -0.2}, {-0.5, 0.0}})
                move_to(motor, load);
            EXPECT_NEAR(bench.load_tension_N(0), 0.0, 1e-6);
            at_motor_N.push_back(bench.motor_tension_N(0));
        }
        EXPECT_NEAR(at_motor_N[0], at_motor_N[2], 1e-3) << "friction " << friction;
        EXPECT_NEAR(at_motor_N[1], at_motor_N[2], 1e-3) << "friction " << friction;
        // From no tension at the load, dT/ds = -(mu T / R + b) (E1 with E24). The drag of the last segment,
        // which is slack, is missing, and so is what friction adds to it on the way.
        const double exponent = friction * length_m / radius_m;
        const double held_N = drag_N_per_m * length_m * std::expm1(exponent) / exponent;
        EXPECT_NEAR(at_motor_N[2], held_N, 3.0 * held_N / segments) << "friction " << friction;
    }
}

TEST(BenchSimulation, RejectsInputsThatDetermineNoMotion) {
    BenchSimulation bench({cable_with(10), CableArrangement::pull_pull, pulleys, {}}, {});
    EXPECT_THROW(bench.advance({MotorTorque{0.1}, LoadTorque{0.1}, time_step_s, 0.0}), InvalidInput);
    EXPECT_THROW(bench.advance({MotorTorque{std::nan("")}, LoadAngle{0.0}, time_step_s, 0.0}), InvalidInput);
    EXPECT_THROW(bench.advance({MotorAngle{0.0}, LoadAngle{0.0}, time_step_s, 0.0, std::nan("")}),
                 InvalidInput);
    EXPECT_THROW(bench.advance({MotorAngle{0.0}, LoadAngle{0.0}, time_step_s, 0.0, {}, std::nan("")}),
                 InvalidInput);
    EXPECT_THROW(bench.advance({MotorTorque{0.1}, LoadAngle{0.0}, 0.0, 0.0}), InvalidInput);
    EXPECT_EQ(bench.motor_angle_rad(), 0.0);
}

TEST(BenchSimulation, RefusesACableOfUnequalSegments) {
    CableSpecification uneven{.curvature = {{2.0, 0.28}},
                              .segments = 10,
                              .axial_stiffness_N = 4000.0,
                              .pretension_N = 6.0,
                              .node_places_m = {0.1}};
    EXPECT_THROW(BenchSimulation({Cable(uneven), CableArrangement::single, pulleys, {}}, {}), InvalidInput);
}

TEST(BenchSimulation, NamesEveryProblemOfItsInputsAtOnce) {
    const double nan = std::nan("");
    BenchSimulation single({cable_with(10), CableArrangement::single, pulleys, {}}, {});
    try {
        single.advance({MotorAngle{nan}, LoadSpring{0.0, nan}, time_step_s, 0.0});
        FAIL();
    } catch (const InvalidInput& refusal) {
        EXPECT_EQ(refusal.problems().size(), 4u) << refusal.what();
    }
    EXPECT_THROW(single.advance({MotorAngle{0.0}, LoadTorque{0.1}, time_step_s, 0.0}), InvalidInput);
    EXPECT_THROW(single.advance({MotorAngle{0.0}, LoadAngle{nan}, time_step_s, 0.0}), InvalidInput);
    EXPECT_NO_THROW(single.advance({MotorAngle{0.0}, LoadAngle{0.0}, time_step_s, 0.0}));
}

}  // namespace
}  // namespace capstan
