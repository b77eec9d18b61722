#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/solver/cable_ensemble.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {
namespace {

// About normal: twelve uniform numbers.
double normal(int seed, int step, int which) {
    std::mt19937_64 bits(static_cast<std::uint64_t>(seed) * 1000003 +
                         static_cast<std::uint64_t>(step) * 1009 + static_cast<std::uint64_t>(which));
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(bits() >> 11) * 0x1p-53;
    return sum;
}

enum class Cut { even, at_bends };

CableSpecification arm(double friction, double stiffness_N, Cut cut = Cut::even) {
    CableSpecification arm{
        .curvature = {{0.3, straight}, {0.2, 0.12}, {0.3, straight}, {0.15, 0.08}, {0.25, straight}},
        .segments = 12,
        .axial_stiffness_N = stiffness_N,
        .dynamic_friction = friction,
        .static_friction = friction * 4.0 / 3.0,
        .pretension_N = 15.0};
    if (cut == Cut::at_bends) arm.node_places_m = bend_ends_m(arm.curvature);
    return arm;
}

// Members with their own numbers, and the same cables one by one.
struct SideBySide {
    static constexpr int members = 16;
    CableEnsemble ensemble;
    std::vector<QuasiStaticStep> steps;
    std::vector<CableState> states;

    SideBySide(int seed, Cut cut) : ensemble(Cable(arm(0.12, 9000.0, cut)), members) {
        for (int j = 0; j < members; ++j) {
            const Cable cable(arm(0.12 * std::exp(0.3 * normal(seed, 0, 2 * j)),
                                  9000.0 * std::exp(0.2 * normal(seed, 0, 2 * j + 1)), cut));
            steps.emplace_back(cable, ModelRules::consistent());
            states.push_back(pretensioned(cable));
            ensemble.compliance_m_per_N()[j] = cable.mean_segment_compliance_m_per_N();
            for (int s = 0; s < cable.segments(); ++s)
                ensemble.sliding_exponent(s)[j] = cable.dynamic_friction() * cable.wrap_angle_rad()[s];
            for (int node = 0; node < cable.nodes(); ++node)
                ensemble.displacement_m(node)[j] = states.back().displacement_m[node];
        }
        ensemble.retune();
    }
};

// Random walks of both ends, at rest now and then, which visit every regime and slack.
void expect_the_same_walk(int seed, double spring_N_per_m, Cut cut = Cut::even) {
    SideBySide pair(seed, cut);
    int disagreements = 0;
    int searched = 0;
    std::vector<double> distal_m(SideBySide::members, 0.0);
    std::vector<double> value(SideBySide::members);
    const int steps = 400;
    for (int n = 1; n <= steps; ++n) {
        const double proximal_m = n % 7 < 2 ? 0.0 : 4e-4 * normal(seed, n, 100);
        for (int j = 0; j < SideBySide::members; ++j) {
            if (n % 5 > 0) distal_m[j] += 2e-4 * normal(seed, n, j);
            value[j] = spring_N_per_m > 0.0 ? 15.0 + spring_N_per_m * distal_m[j] : distal_m[j];
        }
        for (int j = 0; j < SideBySide::members; ++j) {
            const EndCondition distal = spring_N_per_m > 0.0 ? EndCondition{spring_N_per_m, 1.0, value[j]}
                                                             : EndCondition::position_m(value[j]);
            pair.steps[j].advance(
                pair.states[j],
                {EndCondition::position_m(pair.states[j].displacement_m[0] + proximal_m), distal});
        }
        const EnsembleReport report = spring_N_per_m > 0.0
                                          ? pair.ensemble.advance(proximal_m, {spring_N_per_m, 1.0, value})
                                          : pair.ensemble.advance(proximal_m, {1.0, 0.0, value});
        searched += report.searched;
        for (int j = 0; j < SideBySide::members; ++j) {
            bool same = true;
            for (int node = 0; node < pair.ensemble.nodes(); ++node)
                same = same &&
                       std::abs(pair.ensemble.tension_N(node)[j] - pair.states[j].tension_N[node]) < 1e-6;
            disagreements += same ? 0 : 1;
        }
    }
    // A step on the edge of two patterns may fall either way by rounding; then the members part for a while.
    EXPECT_LE(disagreements, steps * SideBySide::members / 200) << "seed " << seed;
    EXPECT_GT(searched, 0);  // the walk must visit what only the search can solve
}

TEST(CableEnsemble, EveryMemberTakesTheStepOfItsOwnCable) {
    for (const int seed : {1, 2, 3, 4, 5}) expect_the_same_walk(seed, 0.0);
}

TEST(CableEnsemble, EveryMemberTakesTheStepOfItsOwnCableAgainstASpring) {
    for (const int seed : {6, 7, 8, 9, 10}) expect_the_same_walk(seed, 3000.0);
}

TEST(CableEnsemble, EveryMemberTakesTheStepOfItsOwnCableWhereSegmentsDifferInLength) {
    for (const int seed : {11, 12, 13}) expect_the_same_walk(seed, 0.0, Cut::at_bends);
    for (const int seed : {14, 15, 16}) expect_the_same_walk(seed, 3000.0, Cut::at_bends);
}

void expect_same_state(const CableState& member, const CableState& alone) {
    ASSERT_EQ(member.tension_N.size(), alone.tension_N.size());
    ASSERT_EQ(member.displacement_m.size(), alone.displacement_m.size());
    for (std::size_t node = 0; node < alone.tension_N.size(); ++node) {
        ASSERT_NEAR(member.tension_N[node], alone.tension_N[node], 1e-6);
        ASSERT_NEAR(member.displacement_m[node], alone.displacement_m[node], 1e-9);
    }
    const MotionPattern& moved = member.last_motion;
    const MotionPattern& expected = alone.last_motion;
    ASSERT_EQ(moved.kind == MotionKind::slack, expected.kind == MotionKind::slack);
    if (expected.kind == MotionKind::slack) return;
    for (int node = 0; node < static_cast<int>(alone.tension_N.size()); ++node) {
        const int segments = static_cast<int>(alone.tension_N.size()) - 1;
        ASSERT_EQ(node_direction(moved, node, segments), node_direction(expected, node, segments));
    }
    if (expected.kind == MotionKind::rest || expected.kind == MotionKind::mass) {
        ASSERT_EQ(moved.kind, expected.kind);
    } else {
        ASSERT_TRUE(moved.kind == MotionKind::partial || moved.kind == MotionKind::opposed);
    }
    if (expected.kind == MotionKind::opposed) {
        ASSERT_EQ(moved.kind, MotionKind::opposed);
    }
}

// Nothing is changed and nothing retuned: all members are the cable that they began as, one state after the
// other.
TEST(CableEnsemble, StepsFromTheStartAsTheCableThatItBeganAs) {
    const Cable cable(arm(0.12, 9000.0));
    const QuasiStaticStep alone(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    CableEnsemble ensemble(cable, 8);
    expect_same_state(ensemble.state_of(5), state);
    const double far_m = state.displacement_m.back();
    int searched = 0;
    for (int step = 1; step <= 120; ++step) {
        const double near_m = step % 9 == 0 ? 0.0 : 1.3e-3 * std::sin(0.2 * step);
        const std::vector<double> value(8, far_m + 1e-3 * std::sin(0.13 * step));
        const bool verified = alone
                                  .advance(state, {EndCondition::position_m(state.displacement_m[0] + near_m),
                                                   EndCondition::position_m(value[0])})
                                  .verified;
        const EnsembleReport report = ensemble.advance(near_m, {1.0, 0.0, value});
        ASSERT_EQ(report.unverified, verified ? 0 : 8) << step;
        ASSERT_TRUE(report.searched == 0 || report.searched == 8);
        searched += report.searched;
        expect_same_state(ensemble.state_of(5), state);
    }
    EXPECT_GT(searched, 0);
}

TEST(CableEnsemble, AMemberMadeSlackStepsAsASlackCableAndTheOthersAsBefore) {
    const Cable cable(arm(0.12, 9000.0));
    const QuasiStaticStep alone(cable, ModelRules::consistent());
    CableState taut = pretensioned(cable);
    CableEnsemble ensemble(cable, 8);
    const std::vector<double> value(8, taut.displacement_m.back());
    const auto step_all = [&](double near_m) { ensemble.advance(near_m, {1.0, 0.0, value}); };
    const auto step_one = [&](CableState& state, double near_m) {
        alone.advance(state, {EndCondition::position_m(state.displacement_m[0] + near_m),
                              EndCondition::position_m(value[0])});
    };
    step_all(-1e-3);
    step_one(taut, -1e-3);
    CableState slack = taut;
    slack.last_motion = {};
    slack.last_motion.kind = MotionKind::slack;
    ensemble.make_slack(2);
    EXPECT_EQ(ensemble.state_of(2).last_motion.proximal_moving_nodes, 0);
    EXPECT_EQ(ensemble.state_of(2).last_motion.proximal_direction, Direction::none);
    for (int step = 0; step < 5; ++step) {
        step_all(-2e-4);
        step_one(taut, -2e-4);
        step_one(slack, -2e-4);
        expect_same_state(ensemble.state_of(2), slack);
        expect_same_state(ensemble.state_of(3), taut);
    }
}

// Every segment bends, so that the friction of each one counts; without friction no ratio may be 0 by 0.
TEST(CableEnsemble, StepsWithAndWithoutFrictionWhereEverySegmentBends) {
    for (const double friction : {0.0, 0.1}) {
        CableSpecification bent = arm(friction, 9000.0);
        bent.curvature = {{0.6, 0.2}, {0.6, 0.15}};
        const Cable cable(bent);
        const QuasiStaticStep alone(cable, ModelRules::consistent());
        CableState state = pretensioned(cable);
        CableEnsemble ensemble(cable, 8);
        ASSERT_EQ(ensemble.segments(), cable.segments());
        const double far_m = state.displacement_m.back();
        for (int step = 1; step <= 60; ++step) {
            const double near_m = 1.3e-3 * std::sin(0.2 * step);
            const std::vector<double> value(8, far_m + 1e-3 * std::sin(0.13 * step));
            alone.advance(state, {EndCondition::position_m(state.displacement_m[0] + near_m),
                                  EndCondition::position_m(value[0])});
            ensemble.advance(near_m, {1.0, 0.0, value});
            expect_same_state(ensemble.state_of(5), state);
        }
    }
}

// Pulled at one end, let go, pulled at the other one and at both: a front runs, all slides, a front runs
// back, a zero-velocity point wanders. The search is for fronts that meet in one segment, which is rare.
TEST(CableEnsemble, SolvesNearlyEveryStepByItsFirstPattern) {
    struct Phase {
        double near_m;
        double far_m;
    };
    for (const double friction : {0.12, 0.0}) {
        CableEnsemble ensemble(Cable(arm(friction, 9000.0)), 8);
        std::vector<double> value(8, ensemble.displacement_m(ensemble.segments())[0]);
        for (const auto& [near_m, far_m] :
             {Phase{-1e-4, 0.0}, {5e-5, 0.0}, {0.0, 1e-4}, {-5e-5, 1e-4}, {-1e-4, 5e-5}, {0.0, -5e-5}}) {
            int searched = 0;
            for (int step = 0; step < 40; ++step) {
                for (double& each : value) each += far_m;
                const EnsembleReport report = ensemble.advance(near_m, {1.0, 0.0, value});
                ASSERT_EQ(report.unverified, 0);
                searched += report.searched;
            }
            EXPECT_LE(searched, 8) << friction << ": " << near_m << " " << far_m;
        }
    }
}

// Prescribed ends are exact to the last bit, and a change of an input within rounding moves nothing.
TEST(CableEnsemble, PutsEndsWhereTheyArePrescribed) {
    CableEnsemble ensemble(Cable(arm(0.12, 9000.0)), 8);
    const int last = ensemble.segments();
    ensemble.advance(-6e-3, {1.0, 0.0, std::vector<double>(8, ensemble.displacement_m(last)[3])});
    for (int step = 1; step <= 60; ++step) {
        const double near_m = ensemble.displacement_m(0)[3];
        const double far_m = ensemble.displacement_m(last)[3];
        const std::vector<double> value(8, far_m + (step % 3 == 0 ? 0.0 : 3e-4 * std::sin(0.7 * step)));
        const double increment_m = step % 4 == 0 ? 0.0 : 3e-4 * std::cos(0.2 * step);
        // E6 with a factor of 2 on both sides.
        std::vector<double> doubled;
        for (const double each : value) doubled.push_back(2.0 * each);
        ensemble.advance(increment_m, {2.0, 0.0, doubled});
        ASSERT_FALSE(ensemble.is_slack(3));
        EXPECT_EQ(ensemble.displacement_m(0)[3], near_m + increment_m) << step;
        EXPECT_EQ(ensemble.displacement_m(last)[3], value[3]) << step;

        const CableState before = ensemble.state_of(3);
        const double tiny_m = 1e-15 * before.displacement_m.front();
        ASSERT_NE(before.displacement_m.front() + tiny_m, before.displacement_m.front());
        const std::vector<double> nudged_m(8, before.displacement_m.back() * (1.0 + 1e-15));
        const std::vector<double> nudged_N(8, before.tension_N.back() * (1.0 + 1e-15));
        for (const CableEnsemble::DistalEnd& distal :
             {CableEnsemble::DistalEnd{1.0, 0.0, nudged_m}, {0.0, 1.0, nudged_N}}) {
            ensemble.advance(tiny_m, distal);
            EXPECT_EQ(ensemble.state_of(3).displacement_m, before.displacement_m) << step;
            EXPECT_EQ(ensemble.state_of(3).tension_N, before.tension_N) << step;
        }
    }
}

// The ratio of the two friction coefficients of a cable without friction would be 0 / 0.
TEST(CableEnsemble, MembersMayHaveFrictionThatTheFirstCableHadNot) {
    CableSpecification rough = arm(0.1, 9000.0);
    rough.static_friction = rough.dynamic_friction;
    const Cable cable(rough);
    const QuasiStaticStep alone(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    CableEnsemble ensemble(Cable(arm(0.0, 9000.0)), 8);
    for (int s = 0; s < cable.segments(); ++s)
        for (double& each : ensemble.sliding_exponent(s))
            each = cable.dynamic_friction() * cable.wrap_angle_rad()[s];
    ensemble.retune();
    const std::vector<double> value(8, state.displacement_m.back());
    for (int step = 1; step <= 60; ++step) {
        const double near_m = -1e-3 * std::cos(0.2 * step);
        alone.advance(state, {EndCondition::position_m(state.displacement_m[0] + near_m),
                              EndCondition::position_m(value[0])});
        ensemble.advance(near_m, {1.0, 0.0, value});
        expect_same_state(ensemble.state_of(5), state);
    }
}

TEST(CableEnsemble, RefusesANumberOfMembersThatFillsNoLanes) {
    EXPECT_THROW(CableEnsemble(Cable(arm(0.1, 9000.0)), 12), InvalidInput);
}

TEST(CableEnsemble, RefusesInputsWhoseTensionsAreBeyondAllNumbers) {
    for (const double near_m : {0.0, -1e180, -1e200}) {
        for (const double far_m : {1e180, 1e200}) {
            CableEnsemble ensemble(Cable(arm(0.1, 9000.0)), 8);
            const std::vector<double> value(8, far_m);
            EXPECT_THROW(ensemble.advance(near_m, {1.0, 0.0, value}), InvalidInput);
        }
    }
}

TEST(CableEnsemble, AnInputThatIsNotFiniteChangesNothing) {
    CableEnsemble ensemble(Cable(arm(0.1, 9000.0)), 8);
    const CableState before = ensemble.state_of(3);
    const std::vector<double> value(8, std::nan(""));
    EXPECT_THROW(ensemble.advance(0.0, {1.0, 0.0, value}), InvalidInput);
    EXPECT_EQ(ensemble.state_of(3).tension_N, before.tension_N);
}

}  // namespace
}  // namespace capstan
