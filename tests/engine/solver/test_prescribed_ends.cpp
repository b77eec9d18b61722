// What the ends obey, and what of it a step refuses.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/pattern_search.h"
#include "capstan/solver/quasi_static_step.h"
#include "example_cables.h"
#include "random_walk.h"

namespace capstan {
namespace {

// To the last bit: the rounding of a sum must not drive the next step.
TEST(PrescribedEnd, ThatMovesIsWhereItIsPrescribed) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    int one_node = 0;
    int slack = 0;
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        test::RandomWalk walk(step.cable(), {test::EndKind::position, test::EndKind::position}, 2e-3, seed);
        CableState state = pretensioned(step.cable());
        for (int k = 0; k < 400; ++k) {
            const EndConditions ends = walk.next(state);
            const MotionPattern pattern = step.advance(state, ends).pattern;
            one_node += pattern.distal_moving_nodes == 1 ? 1 : 0;
            slack += pattern.kind == MotionKind::slack ? 1 : 0;
            if (pattern.proximal_moving_nodes > 0) {
                ASSERT_EQ(state.displacement_m.front(), ends.proximal.value);
            }
            if (pattern.distal_moving_nodes > 0) {
                ASSERT_EQ(state.displacement_m.back(), ends.distal.value);
            }
        }
    }
    EXPECT_GT(one_node, 0);
    EXPECT_GT(slack, 0);
}

TEST(PrescribedEnd, OfATensionHasThatTension) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    test::RandomWalk walk(step.cable(), {test::EndKind::position, test::EndKind::tension}, 5e-4, 5);
    CableState state = pretensioned(step.cable());
    int moved = 0;
    for (int k = 0; k < 400; ++k) {
        const EndConditions ends = walk.next(state);
        const StepReport report = step.advance(state, ends);
        if (report.pattern.distal_moving_nodes == 0) continue;
        ++moved;
        ASSERT_EQ(state.tension_N.back(), ends.distal.value);
    }
    EXPECT_GT(moved, 100);
}

// A factor on both sides of E6 changes nothing. A power of two as the factor is exact.
TEST(PrescribedEnd, ScalingItsEquationChangesNothing) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    const auto times = [](double factor, const EndCondition& end) {
        return EndCondition{factor * end.displacement_factor, factor * end.tension_factor,
                            factor * end.value};
    };
    for (const test::InputPair& pair : test::every_input_pair()) {
        test::RandomWalk walk(step.cable(), pair, 5e-4, 7);
        CableState state = pretensioned(step.cable());
        CableState other = state;
        for (int k = 0; k < 200; ++k) {
            const EndConditions ends = walk.next(state);
            step.advance(state, ends);
            step.advance(other, {times(4.0, ends.proximal), times(0.5, ends.distal)});
            ASSERT_EQ(other.tension_N, state.tension_N) << k;
            ASSERT_EQ(other.displacement_m, state.displacement_m) << k;
        }
    }
}

// A change of an input below the rounding error of the terms of E6 drives nothing.
TEST(PrescribedEnd, AChangeWithinRoundingMovesNothing) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    CableState state = pretensioned(step.cable());
    step.advance(state, {EndCondition::position_m(-8e-3), EndCondition::position_m(3e-3)});
    const CableState before = state;
    for (const double change : {-1e-15, 1e-15}) {
        const EndCondition near = EndCondition::position_m(before.displacement_m.front() * (1.0 + change));
        const EndCondition far = EndCondition::position_m(before.displacement_m.back() * (1.0 + change));
        const EndCondition far_N = EndCondition::tension_N(before.tension_N.back() * (1.0 + change));
        ASSERT_NE(near.value, before.displacement_m.front());
        for (const EndCondition& distal : {far, far_N}) {
            EXPECT_EQ(step.advance(state, {near, distal}).pattern.kind, MotionKind::rest);
            EXPECT_EQ(state.displacement_m, before.displacement_m);
            EXPECT_EQ(state.tension_N, before.tension_N);
        }
    }
}

// A refusal names the end and the reason, and the state is unchanged.
class RefusedEnds : public testing::Test {
  protected:
    void expect_refused(const EndConditions& ends, const std::string& because) const {
        CableState state = pretensioned(step.cable());
        const CableState before = state;
        try {
            step.advance(state, ends);
            FAIL() << "not refused: " << because;
        } catch (const InvalidInput& refused) {
            EXPECT_NE(std::string(refused.what()).find(because), std::string::npos) << refused.what();
        }
        EXPECT_EQ(state.tension_N, before.tension_N);
        EXPECT_EQ(state.displacement_m, before.displacement_m);
    }

    const QuasiStaticStep step{test::paper_cable(10), ModelRules::consistent()};
    const EndCondition fixed = EndCondition::position_m(0.0);
};

TEST_F(RefusedEnds, SayNothing) {
    const EndCondition nothing{0.0, 0.0, 1.0};
    expect_refused({fixed, nothing}, "the distal end's input says nothing");
    expect_refused({nothing, fixed}, "the proximal end's input says nothing");
    expect_refused({EndCondition::tension_N(1.0), EndCondition::tension_N(1.0)},
                   "a tension is prescribed at both ends");
}

TEST_F(RefusedEnds, AreBeyondAllNumbers) {
    for (const double huge : {1e151, -1e151, 1e300, -1e300}) {
        const double factor = std::abs(huge);
        expect_refused({fixed, EndCondition::position_m(huge)}, "the distal end's input is not a finite");
        expect_refused({EndCondition::position_m(huge), fixed}, "the proximal end's input is not a finite");
        expect_refused({fixed, {0.0, huge, 1.0}}, "the distal end's input is not a finite");
        expect_refused({{0.0, huge, 1.0}, fixed}, "the proximal end's input is not a finite");
        expect_refused({fixed, {factor, 1.0, 1.0}}, "the distal end's input is not a finite");
        expect_refused({{-factor, 1.0, 1.0}, fixed}, "the proximal end's input is not a finite");
    }
}

// The friction of a cable, handed on as exponents, gives the steps of that cable; twice the friction those of
// a cable with twice the friction.
TEST(SlidingExponents, AreThoseOfACableWithSuchFriction) {
    for (const double factor : {1.0, 2.0}) {
        CableSpecification rougher = test::paper_specification(10);
        rougher.dynamic_friction *= factor;
        rougher.static_friction = rougher.dynamic_friction;
        const QuasiStaticStep expected{Cable(rougher), ModelRules::consistent()};
        QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
        std::vector<double> exponents;
        for (const double wrap_rad : expected.cable().wrap_angle_rad())
            exponents.push_back(expected.cable().dynamic_friction() * wrap_rad);
        step.set_sliding_exponents(exponents);
        CableState one = pretensioned(step.cable());
        CableState other = one;
        for (int k = 1; k <= 100; ++k) {
            const EndConditions ends{EndCondition::position_m(-3e-3 * std::sin(0.1 * k)),
                                     EndCondition::position_m(2e-3 * std::sin(0.07 * k))};
            step.advance(one, ends);
            expected.advance(other, ends);
            for (std::size_t node = 0; node < one.tension_N.size(); ++node)
                ASSERT_NEAR(one.tension_N[node], other.tension_N[node], 1e-9) << k;
        }
    }
}

TEST(SlidingExponents, AreOnePerSegmentAndNeedTheRuleOfTheMeanTension) {
    QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    EXPECT_THROW(step.set_sliding_exponents(std::vector<double>(9, 0.1)), InvalidInput);
    EXPECT_NO_THROW(step.set_sliding_exponents(std::vector<double>(10, 0.1)));
    ModelRules rules = ModelRules::consistent();
    rules.elongation = ElongationRule::exponential_and_mean;
    QuasiStaticStep other(test::paper_cable(10), rules);
    EXPECT_THROW(other.set_sliding_exponents(std::vector<double>(10, 0.1)), InvalidInput);
}

TEST(PatternSearch, HasVerifiedNothingBeforeItBegins) {
    EXPECT_FALSE(PatternSearch{}.verified);
}

}  // namespace
}  // namespace capstan
