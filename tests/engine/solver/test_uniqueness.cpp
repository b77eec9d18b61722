// The step's answer against every one of the 3^N sign vectors, over random walks of both ends.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "example_cables.h"
#include "sign_vector_enumeration.h"

namespace capstan {
namespace {

enum class Mode { position_position, position_tension, tension_position, position_spring, spring_position };

struct Tally {
    int steps = 0;
    int several = 0;      // more than one state verifies
    int none = 0;
    int disagreements = 0;  // the only verified state is not the step's
    int unverified = 0;   // the step says of itself that it is not verified
};

struct Walk {
    int segments;
    double static_friction;
    Mode mode;
    double step_m;  // largest, of a position; a tension moves by the force that would stretch the cable as much
};

EndConditions random_ends(const Walk& walk, const CableState& state, const Cable& cable, std::mt19937_64& random) {
    std::uniform_real_distribution<double> within(-1.0, 1.0);
    const double proximal_m = state.displacement_m.front() + walk.step_m * within(random);
    const double distal_m = state.displacement_m.back() + walk.step_m * within(random);
    const double force_N = walk.step_m * cable.axial_stiffness_N() / cable.length_m();
    const auto tension = [&](double now_N) {
        return EndCondition::tension_N(std::max(now_N + force_N * within(random), 0.5));
    };
    const double stiffness = 500.0;
    switch (walk.mode) {
        case Mode::position_position:
            return {EndCondition::position_m(proximal_m), EndCondition::position_m(distal_m)};
        case Mode::position_tension:
            return {EndCondition::position_m(proximal_m), tension(state.tension_N.back())};
        case Mode::tension_position:
            return {tension(state.tension_N.front()), EndCondition::position_m(distal_m)};
        case Mode::position_spring:
            return {EndCondition::position_m(proximal_m),
                    distal_spring({stiffness, state.tension_N.back(), distal_m})};
        case Mode::spring_position:
            return {proximal_spring({stiffness, state.tension_N.front(), proximal_m}),
                    EndCondition::position_m(distal_m)};
    }
    return {};
}

Tally walk_and_compare(const Walk& walk, int steps, unsigned seed) {
    CableSpecification specification = test::paper_specification(walk.segments);
    specification.static_friction = walk.static_friction;
    const Cable cable(specification);
    const QuasiStaticStep step(cable, ModelRules::cured());
    CableState state = pretensioned(cable);
    std::mt19937_64 random(seed);
    Tally tally;
    for (int k = 0; k < steps; ++k) {
        EndConditions ends = random_ends(walk, state, cable, random);
        CableState next = state;
        const StepReport report = step.advance(next, ends);
        const double stretch_m = next.displacement_m.back() - next.displacement_m.front();
        if (report.pattern.kind == MotionKind::slack || stretch_m < 2e-3 || stretch_m > 40e-3) {
            state = pretensioned(cable);  // walk back to the middle
            continue;
        }
        const auto verified = test::all_verified_states(cable, state, ends, 1e-7);
        ++tally.steps;
        tally.unverified += !report.verified;
        tally.none += verified.empty();
        tally.several += verified.size() > 1;
        if (verified.size() == 1) {
            double apart_N = 0.0;
            for (int node = 0; node < cable.nodes(); ++node) {
                apart_N = std::max(apart_N, std::abs(verified[0].tension_N[node] - next.tension_N[node]));
            }
            tally.disagreements += apart_N > 1e-6;
        }
        state = next;
    }
    return tally;
}

class OnlyOneStateVerifies : public testing::TestWithParam<std::tuple<int, double, Mode>> {};

TEST_P(OnlyOneStateVerifies, AtStepsOfATenthOfAMillimetre) {
    const auto [segments, static_friction, mode] = GetParam();
    const Tally tally = walk_and_compare({segments, static_friction, mode, 1e-4}, 400, 7);
    EXPECT_GT(tally.steps, 300);
    EXPECT_EQ(tally.none, 0);
    EXPECT_EQ(tally.several, 0);
    EXPECT_EQ(tally.disagreements, 0);
    EXPECT_EQ(tally.unverified, 0);
}

INSTANTIATE_TEST_SUITE_P(AllModes, OnlyOneStateVerifies,
                         testing::Combine(testing::Values(4, 5), testing::Values(0.21, 0.63),
                                          testing::Values(Mode::position_position, Mode::position_tension,
                                                          Mode::tension_position, Mode::position_spring,
                                                          Mode::spring_position)));

TEST(Uniqueness, StepsOfFourTenthsOfAMillimetreAreSeldomAmbiguousAndNeverWithoutAnAnswer) {
    const Tally tally = walk_and_compare({4, 0.21, Mode::position_position, 4e-4}, 2000, 11);
    EXPECT_EQ(tally.none, 0);
    EXPECT_LE(tally.several, tally.steps / 100);
    EXPECT_EQ(tally.unverified, 0);
}

}  // namespace
}  // namespace capstan
