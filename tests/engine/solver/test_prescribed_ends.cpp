// What the ends obey, and what of it a step refuses.

#include <gtest/gtest.h>

#include <cmath>
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

TEST(PrescribedEnd, ThatSaysNothingIsRefused) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    const EndCondition fixed = EndCondition::position_m(0.0);
    for (const EndConditions& ends :
         {EndConditions{fixed, {0.0, 0.0, 1.0}}, EndConditions{{0.0, 0.0, 1.0}, fixed},
          EndConditions{EndCondition::tension_N(1.0), EndCondition::tension_N(1.0)}}) {
        CableState state = pretensioned(step.cable());
        const CableState before = state;
        EXPECT_THROW(step.advance(state, ends), InvalidInput);
        EXPECT_EQ(state.tension_N, before.tension_N);
    }
}

TEST(PrescribedEnd, BeyondAllNumbersIsRefused) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    for (const double huge : {1e151, -1e151, 1e300}) {
        CableState state = pretensioned(step.cable());
        EXPECT_THROW(step.advance(state, {EndCondition::position_m(0.0), EndCondition::position_m(huge)}),
                     InvalidInput);
        EXPECT_THROW(step.advance(state, {EndCondition::position_m(huge), EndCondition::position_m(0.0)}),
                     InvalidInput);
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
