// Many replicates in vectors against the single step, each replicate on a walk of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/replicate_step.h"
#include "example_cables.h"

namespace capstan {
namespace {

enum class Inputs { position_position, position_tension, tension_position, position_spring, spring_position };

struct Walk {
    int segments;
    Inputs inputs;
    double step_m;  // largest, of a position
};

// Each replicate drifts its own way for a while, so that the members of a group are in different motions, and
// now and then holds still.
EndConditions next_ends(const Walk& walk, const CableState& state, const Cable& cable,
                        std::mt19937_64& random) {
    std::uniform_real_distribution<double> within(-1.0, 1.0);
    const bool still = within(random) > 0.8;
    const double proximal_m = state.displacement_m.front() + (still ? 0.0 : walk.step_m * within(random));
    const double distal_m = state.displacement_m.back() + walk.step_m * within(random);
    const double force_N = walk.step_m * cable.axial_stiffness_N() / cable.length_m();
    const auto tension = [&](double now_N) {
        return EndCondition::tension_N(std::max(now_N + force_N * within(random), 0.0));
    };
    switch (walk.inputs) {
        case Inputs::position_position:
            return {EndCondition::position_m(proximal_m), EndCondition::position_m(still ? 0.0 : distal_m)};
        case Inputs::position_tension:
            return {EndCondition::position_m(proximal_m), tension(state.tension_N.back())};
        case Inputs::tension_position:
            return {tension(state.tension_N.front()), EndCondition::position_m(distal_m)};
        case Inputs::position_spring:
            return {EndCondition::position_m(proximal_m), distal_spring({40.0, 10.0, 0.0})};
        case Inputs::spring_position:
            return {proximal_spring({500.0, state.tension_N.front(), proximal_m}),
                    EndCondition::position_m(distal_m)};
    }
    return {};
}

struct Tally {
    int differing = 0;           // states, motions or verdicts
    std::array<int, 5> kinds{};  // steps of each MotionKind
    int one_by_one = 0;
    int steps = 0;
};

Tally walk_beside_the_single_step(const Walk& walk, const ModelRules& rules, int replicates, int samples) {
    const Cable cable = test::paper_cable(walk.segments);
    const ReplicateStep step(cable, rules);
    ReplicateStates states(pretensioned(cable), replicates);
    ReplicateEnds ends(replicates);
    std::vector<CableState> singles(replicates, pretensioned(cable));
    std::mt19937_64 random(walk.segments);
    Tally tally;
    for (int sample = 0; sample < samples; ++sample) {
        for (int r = 0; r < replicates; ++r) {
            if (singles[r].displacement_m.back() - singles[r].displacement_m.front() > 0.05) {
                singles[r] = pretensioned(cable);
                states.set(r, singles[r]);
            }
            ends.set(r, next_ends(walk, singles[r], cable, random));
        }
        const ReplicateReport report = step.advance(states, ends);
        int unverified = 0;
        for (int r = 0; r < replicates; ++r) {
            const StepReport single = step.single().advance(singles[r], ends.ends(r));
            const CableState together = states.state(r);
            tally.differing += together.tension_N != singles[r].tension_N ||
                               together.displacement_m != singles[r].displacement_m ||
                               together.last_motion != singles[r].last_motion ||
                               states.verified(r) != single.verified;
            unverified += !single.verified;
            ++tally.kinds[static_cast<std::size_t>(single.pattern.kind)];
        }
        tally.differing += report.unverified != unverified;
        tally.one_by_one += report.one_by_one;
        tally.steps += replicates;
    }
    return tally;
}

class Replicates : public testing::TestWithParam<std::tuple<int, Inputs, double>> {};

// 19: two whole groups and a part of one.
TEST_P(Replicates, AreWhereTheSingleStepTakesThemToTheBit) {
    const auto [segments, inputs, step_m] = GetParam();
    const Tally tally =
        walk_beside_the_single_step({segments, inputs, step_m}, ModelRules::consistent(), 19, 400);
    EXPECT_EQ(tally.differing, 0);
    EXPECT_GT(tally.kinds[static_cast<std::size_t>(MotionKind::partial)], 0);
}

std::string name_of_walk(const testing::TestParamInfo<std::tuple<int, Inputs, double>>& info) {
    const std::vector<std::string> names = {"PositionPosition", "PositionTension", "TensionPosition",
                                            "PositionSpring", "SpringPosition"};
    const auto [segments, inputs, step_m] = info.param;
    return names[static_cast<std::size_t>(inputs)] + std::to_string(segments) + "Segments" +
           (step_m > 1e-3 ? "LongSteps" : "ShortSteps");
}

INSTANTIATE_TEST_SUITE_P(Replicates, Replicates,
                         testing::Combine(testing::Values(2, 5, 10, 33),
                                          testing::Values(Inputs::position_position, Inputs::position_tension,
                                                          Inputs::tension_position, Inputs::position_spring,
                                                          Inputs::spring_position),
                                          testing::Values(2e-4, 4e-3)),
                         name_of_walk);

TEST(ReplicateStep, EveryMotionOccursInTheseWalks) {
    const Tally tally = walk_beside_the_single_step({10, Inputs::position_position, 4e-3},
                                                    ModelRules::consistent(), 16, 1000);
    for (const int steps : tally.kinds) EXPECT_GT(steps, 10);
}

TEST(ReplicateStep, LeavesToTheSingleStepOnlyWhatIsNeitherRestPartialNorMassMotion) {
    const Tally tally =
        walk_beside_the_single_step({10, Inputs::position_spring, 2e-4}, ModelRules::consistent(), 16, 1000);
    EXPECT_GT(tally.kinds[static_cast<std::size_t>(MotionKind::partial)], 1000);
    EXPECT_LT(tally.one_by_one, tally.steps / 100);
}

TEST(ReplicateStep, ThePapersRulesGoOneByOneToTheSameAnswer) {
    const Tally tally =
        walk_beside_the_single_step({10, Inputs::position_position, 2e-4}, ModelRules::paper(), 9, 200);
    EXPECT_EQ(tally.differing, 0);
    EXPECT_EQ(tally.one_by_one, tally.steps);
}

TEST(ReplicateStep, FrictionWithoutMemoryGoesTogetherToTheSameAnswerToo) {
    ModelRules memoryless = ModelRules::consistent();
    memoryless.stiction = StictionRule::memoryless;
    const Tally tally = walk_beside_the_single_step({10, Inputs::position_spring, 2e-4}, memoryless, 16, 400);
    EXPECT_EQ(tally.differing, 0);
    EXPECT_LT(tally.one_by_one, tally.steps / 10);
}

TEST(ReplicateStep, WrongInputIsRefusedAndNothingMoves) {
    const Cable cable = test::paper_cable(4);
    const ReplicateStep step(cable, ModelRules::consistent());
    EXPECT_THROW(ReplicateStates(pretensioned(cable), 0), InvalidInput);
    EXPECT_THROW(ReplicateEnds(0), InvalidInput);
    ReplicateStates states(pretensioned(cable), 3);
    EXPECT_THROW(step.advance(states, ReplicateEnds(4)), InvalidInput);
    ReplicateEnds ends(3);
    EXPECT_THROW(ends.set(1, {EndCondition::tension_N(1.0), EndCondition::tension_N(1.0)}), InvalidInput);
    EXPECT_THROW(ends.set(1, {EndCondition::position_m(std::nan("")), EndCondition::position_m(0.0)}),
                 InvalidInput);
    for (int replicate = 0; replicate < 3; ++replicate) {
        EXPECT_EQ(states.state(replicate).tension_N, pretensioned(cable).tension_N);
        EXPECT_EQ(ends.ends(replicate).proximal.tension_factor, 0.0);
    }
}

}  // namespace
}  // namespace capstan
