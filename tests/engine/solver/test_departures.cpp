// Why the paper's reading is not the default: its counterexamples (engine/README.md, departures).
#include <gtest/gtest.h>

#include <cmath>

#include "capstan/solver/candidate.h"
#include "example_cables.h"
#include "mirror.h"
#include "trajectories.h"

namespace capstan {
namespace {

// N = 4, mu_s = mu_d, uniform 10 N; the proximal end goes from -10 mm to -9.81951 mm.
class UniquenessProof : public testing::Test {
  protected:
    static Cable four_segments() {
        CableSpecification specification = test::paper_specification(4);
        specification.static_friction = specification.dynamic_friction;
        return Cable(specification);
    }

    Candidate with_moving_nodes(const PrefixTables& tables, const ModelRules& rules, int moving_nodes) const {
        const EndConditions ends{EndCondition::position_m(-9.81951e-3), {}};
        const StepView view{tables, rules, state};
        const CableEnd<End::proximal> end(view, ends);
        const EndValues values = end.partial_motion(end.table(Direction::forward), moving_nodes);
        return partial_motion({Direction::forward, moving_nodes, values}, {});
    }

    Cable cable = four_segments();
    CableState state = pretensioned(cable);
};

TEST_F(UniquenessProof, DoesNotHold_TwoPatternsPassThePapersChecks) {
    const ModelRules rules = ModelRules::paper();
    const PrefixTables tables(cable, rules);
    const StepView view{tables, rules, state};
    const Candidate all_at_rest = with_moving_nodes(tables, rules, 1);
    const Candidate one_segment_moving = with_moving_nodes(tables, rules, 2);
    EXPECT_TRUE(verifies(view, all_at_rest));
    EXPECT_TRUE(verifies(view, one_segment_moving));
    EXPECT_NEAR(all_at_rest.proximal.tension_N, 8.556, 5e-4);
    EXPECT_NEAR(one_segment_moving.proximal.tension_N, 7.357, 5e-4);
    EXPECT_NEAR(moving_tension_N(view, one_segment_moving, 1), 10.70, 5e-3);
}

TEST_F(UniquenessProof, TestingEveryNodeRefusesTheSecondPattern) {
    const ModelRules rules = ModelRules::consistent();
    const PrefixTables tables(cable, rules);
    const StepView view{tables, rules, state};
    EXPECT_TRUE(verifies(view, with_moving_nodes(tables, rules, 1)));
    EXPECT_FALSE(verifies(view, with_moving_nodes(tables, rules, 2)));
}

TEST(ElongationRules, TwoOfThemOpenAGapWhenAFrontPasses) {
    // E2 and E3 at equal tensions differ by a^2 / 12, 0.19% at a = 0.15.
    const double exponent = 0.21 * 0.2 / 0.28;
    const double e2 = sliding_elongation_m_per_N(ElongationRule::exponential_and_mean, 1.0, exponent);
    const double mean = sliding_elongation_m_per_N(ElongationRule::mean_tension, 1.0, exponent);
    EXPECT_NEAR(mean / e2 - 1.0, exponent * exponent / 12.0, 1e-5);
}

// The gap of the paper's two rules, of the size of a segment's friction, can be more than the tension there.
TEST(ElongationRules, WhereTheirGapLeavesNoAnswerTheCableStillDoesNotPush) {
    CableSpecification specification = test::paper_specification(2);
    specification.dynamic_friction = specification.static_friction;
    const QuasiStaticStep step(Cable(specification), ModelRules::paper());
    const EndConditions pushed{EndCondition::position_m(0.005), EndCondition::position_m(0.02)};
    const EndConditions turned{EndCondition::position_m(0.0049), EndCondition::position_m(0.0199)};
    CableState state = pretensioned(step.cable());
    step.advance(state, pushed);
    EXPECT_FALSE(step.advance(state, turned).verified);
    for (const double tension_N : state.tension_N) EXPECT_GE(tension_N, 0.0);

    CableState image = test::mirrored(pretensioned(step.cable()));
    step.advance(image, test::mirrored(pushed));
    EXPECT_FALSE(step.advance(image, test::mirrored(turned)).verified);
    for (const double tension_N : image.tension_N) EXPECT_GE(tension_N, 0.0);
}

TEST(ZeroVelocityPoint, LiesInsideASegmentWhereNoNodeRests) {
    // Both ends are pulled apart until no node rests: without E7 and E8 nothing verifies.
    const Cable cable = test::paper_cable(5);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    int no_node_rests = 0;
    for (int k = 1; k <= 60; ++k) {
        const double apart_m = 2e-4 * k;
        const StepReport report = step.advance(
            state, {EndCondition::position_m(-0.01 - apart_m), EndCondition::position_m(apart_m)});
        EXPECT_TRUE(report.verified);
        const MotionPattern& pattern = report.pattern;
        no_node_rests += pattern.kind != MotionKind::mass &&
                         pattern.proximal_moving_nodes + pattern.distal_moving_nodes == cable.nodes();
    }
    EXPECT_GT(no_node_rests, 30);
    // Symmetric pulling keeps the profile symmetric, highest at the ends.
    EXPECT_NEAR(state.tension_N.front(), state.tension_N.back(), 1e-9);
    EXPECT_GT(state.tension_N.front(), state.tension_N[2]);
}

}  // namespace
}  // namespace capstan
