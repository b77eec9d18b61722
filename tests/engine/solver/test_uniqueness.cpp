// The step's answer against every one of the 3^N sign vectors, over random walks of both ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "example_cables.h"
#include "random_walk.h"
#include "sign_vector_enumeration.h"

namespace capstan {
namespace {

using test::InputPair;

struct Tally {
    int steps = 0;
    int several = 0;  // more than one state verifies
    int none = 0;
    int not_among = 0;   // the step's state is not among those that verify
    int not_least = 0;   // another state that verifies moves fewer nodes
    int unverified = 0;  // the step says of itself that it is not verified
    int partial = 0;
    int mass = 0;
    int opposed = 0;

    int failures() const { return none + not_among + unverified; }
    Tally& operator+=(const Tally& more) {
        steps += more.steps;
        several += more.several;
        none += more.none;
        not_among += more.not_among;
        not_least += more.not_least;
        unverified += more.unverified;
        partial += more.partial;
        mass += more.mass;
        opposed += more.opposed;
        return *this;
    }
    void tell() const {
        std::cout << "    " << steps << " steps (" << partial << " partial, " << mass << " mass, " << opposed
                  << " opposed): " << failures() << " failed, " << several << " with several answers\n";
    }
};

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

void compare_with_all(const Cable& cable, const CableState& before, const EndConditions& ends,
                      const CableState& after, Tally& tally) {
    const auto verified = test::all_verified_states(cable, before, ends, 1e-7);
    tally.none += verified.empty();
    tally.several += verified.size() > 1;
    if (verified.empty()) return;
    int fewest = cable.nodes();
    bool among = false;
    for (const CableState& other : verified) {
        fewest = std::min(fewest, moved_nodes(before, other));
        among = among || apart_N(other, after) < 1e-6;
    }
    tally.not_among += !among;
    tally.not_least += fewest < moved_nodes(before, after);
}

constexpr int steps_from_one_state = 25;

Tally walk_and_compare(const Cable& cable, const InputPair& pair, double step_m, int steps, unsigned seed) {
    const QuasiStaticStep step(cable, ModelRules::consistent());
    test::RandomWalk walk(cable, pair, step_m, seed);
    CableState state = pretensioned(cable);
    Tally tally;
    for (int k = 0; k < steps; ++k) {
        if (k % steps_from_one_state == 0) state = test::random_state(step, seed + k);
        const EndConditions ends = walk.next(state);
        CableState next = state;
        const StepReport report = step.advance(next, ends);
        if (report.pattern.kind == MotionKind::slack || !test::moderately_stretched(next)) {
            state = test::random_state(step, seed + steps + k);
            continue;
        }
        ++tally.steps;
        tally.unverified += !report.verified;
        tally.partial += report.pattern.kind == MotionKind::partial;
        tally.mass += report.pattern.kind == MotionKind::mass;
        tally.opposed += report.pattern.kind == MotionKind::opposed;
        compare_with_all(cable, state, ends, next, tally);
        state = next;
    }
    return tally;
}

enum class Conduit { bent_evenly, bends_differ };

Cable cable_of(int segments, Conduit conduit, double static_friction) {
    CableSpecification specification = test::paper_specification(segments);
    specification.static_friction = static_friction;
    if (conduit == Conduit::bends_differ) {
        std::mt19937_64 random(segments);
        std::uniform_real_distribution<double> radius_m(0.1, 0.6);
        specification.curvature.clear();
        for (int piece = 0; piece < 7; ++piece) {
            specification.curvature.push_back({2.0 / 7.0, piece == 3 ? straight : radius_m(random)});
        }
    }
    return Cable(specification);
}

class EveryMode : public testing::TestWithParam<std::tuple<int, InputPair>> {
  protected:
    // Six segments have 729 sign vectors, so they take fewer steps.
    static int steps(int segments) { return segments < 5 ? 400 : segments < 6 ? 150 : 75; }

    Tally over_both_conduits(double static_friction, double step_m, unsigned seed) const {
        const auto [segments, pair] = GetParam();
        Tally tally;
        for (const Conduit conduit : {Conduit::bent_evenly, Conduit::bends_differ}) {
            tally += walk_and_compare(cable_of(segments, conduit, static_friction), pair, step_m,
                                      steps(segments), seed);
        }
        tally.tell();
        EXPECT_GT(tally.steps, 2 * steps(segments) * 3 / 4);
        return tally;
    }
};

void expect_one_answer(const Tally& tally) {
    EXPECT_EQ(tally.failures(), 0);
    EXPECT_EQ(tally.several, 0);
}

TEST_P(EveryMode, OnlyTheStepsAnswerVerifiesAtStepsOfATenthOfAMillimetre) {
    expect_one_answer(over_both_conduits(0.21, 1e-4, 7));
}

TEST_P(EveryMode, OnlyTheStepsAnswerVerifiesAtStepsOfTwentyMicrometres) {
    expect_one_answer(over_both_conduits(0.21, 2e-5, 17));
}

// With mu_s above mu_d a front may both hold and give way: that is stiction, and the step moves no more than
// it must.
TEST_P(EveryMode, WithStictionTheStepsAnswerVerifiesAndMovesTheFewestNodes) {
    const Tally tally = over_both_conduits(0.63, 1e-4, 13);
    EXPECT_EQ(tally.failures(), 0);
    EXPECT_EQ(tally.not_least, 0);
}

std::string name_of_mode(const testing::TestParamInfo<std::tuple<int, InputPair>>& info) {
    const auto [segments, pair] = info.param;
    return test::name_of(pair) + std::to_string(segments) + "Segments";
}

INSTANTIATE_TEST_SUITE_P(Uniqueness, EveryMode,
                         testing::Combine(testing::Range(2, 7), testing::ValuesIn(test::every_input_pair())),
                         name_of_mode);

TEST(Uniqueness, HoldsAtStepsOfFourTenthsOfAMillimetreToo) {
    const InputPair positions{test::EndKind::position, test::EndKind::position};
    const Tally tally = walk_and_compare(cable_of(4, Conduit::bent_evenly, 0.21), positions, 4e-4, 3000, 11);
    EXPECT_GT(tally.steps, 2900);
    expect_one_answer(tally);
}

}  // namespace
}  // namespace capstan
