// The step's answer against every one of the 3^N sign vectors, over random walks of both ends.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "example_cables.h"
#include "sign_vector_enumeration.h"

namespace capstan {
namespace {

enum class Mode { position_position, position_tension, tension_position, position_spring, spring_position };

struct Tally {
    int steps = 0;
    int several = 0;  // more than one state verifies
    int none = 0;
    int not_among = 0;   // the step's state is not among those that verify
    int not_least = 0;   // another state that verifies moves fewer nodes
    int unverified = 0;  // the step says of itself that it is not verified
};

struct Walk {
    int segments;
    double static_friction;
    Mode mode;
    double
        step_m;  // largest, of a position; a tension moves by the force that would stretch the cable as much
};

EndConditions random_ends(const Walk& walk, const CableState& state, const Cable& cable,
                          std::mt19937_64& random) {
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

double apart_N(const CableState& a, const CableState& b) {
    double apart = 0.0;
    for (std::size_t node = 0; node < a.tension_N.size(); ++node) {
        apart = std::max(apart, std::abs(a.tension_N[node] - b.tension_N[node]));
    }
    return apart;
}

int moved_nodes(const CableState& before, const CableState& after) {
    int moved = 0;
    for (std::size_t node = 0; node < before.displacement_m.size(); ++node) {
        moved += std::abs(after.displacement_m[node] - before.displacement_m[node]) > 1e-10;
    }
    return moved;
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
        if (!verified.empty()) {
            const auto moved = [&](const CableState& s) { return moved_nodes(state, s); };
            int fewest = cable.nodes();
            bool among = false;
            for (const CableState& other : verified) {
                fewest = std::min(fewest, moved(other));
                among = among || apart_N(other, next) < 1e-6;
            }
            tally.not_among += !among;
            tally.not_least += fewest < moved(next);
        }
        state = next;
    }
    return tally;
}

class EveryMode : public testing::TestWithParam<std::tuple<int, Mode>> {};

TEST_P(EveryMode, OnlyTheStepsAnswerVerifiesAtStepsOfATenthOfAMillimetre) {
    const auto [segments, mode] = GetParam();
    const Tally tally = walk_and_compare({segments, 0.21, mode, 1e-4}, 600, 7);
    EXPECT_GT(tally.steps, 500);
    EXPECT_EQ(tally.none, 0);
    EXPECT_EQ(tally.several, 0);
    EXPECT_EQ(tally.not_among, 0);
    EXPECT_EQ(tally.unverified, 0);
}

// With mu_s above mu_d a front may both hold and give way: that is stiction, and the step moves no more than
// it must.
TEST_P(EveryMode, WithStictionTheStepsAnswerVerifiesAndMovesTheFewestNodes) {
    const auto [segments, mode] = GetParam();
    const Tally tally = walk_and_compare({segments, 0.63, mode, 1e-4}, 600, 13);
    EXPECT_GT(tally.steps, 500);
    EXPECT_EQ(tally.none, 0);
    EXPECT_EQ(tally.not_among, 0);
    EXPECT_EQ(tally.not_least, 0);
    EXPECT_EQ(tally.unverified, 0);
}

std::string name_of_mode(const testing::TestParamInfo<std::tuple<int, Mode>>& info) {
    const std::vector<std::string> names = {"PositionPosition", "PositionTension", "TensionPosition",
                                            "PositionSpring", "SpringPosition"};
    const auto [segments, mode] = info.param;
    return names[static_cast<std::size_t>(mode)] + std::to_string(segments) + "Segments";
}

INSTANTIATE_TEST_SUITE_P(Uniqueness, EveryMode,
                         testing::Combine(testing::Values(4, 5),
                                          testing::Values(Mode::position_position, Mode::position_tension,
                                                          Mode::tension_position, Mode::position_spring,
                                                          Mode::spring_position)),
                         name_of_mode);

TEST(Uniqueness, HoldsAtStepsOfFourTenthsOfAMillimetreToo) {
    const Tally tally = walk_and_compare({4, 0.21, Mode::position_position, 4e-4}, 3000, 11);
    EXPECT_GT(tally.steps, 2900);
    EXPECT_EQ(tally.none, 0);
    EXPECT_EQ(tally.several, 0);
    EXPECT_EQ(tally.not_among, 0);
    EXPECT_EQ(tally.unverified, 0);
}

}  // namespace
}  // namespace capstan
