// What a motion pattern says of both ends, and where friction gives way.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "capstan/solver/candidate.h"
#include "example_cables.h"

namespace capstan {
namespace {

class Candidates : public testing::Test {
  protected:
    const Cable cable = test::paper_cable(10);
    const ModelRules rules = ModelRules::consistent();
    const PrefixTables tables{cable, rules};
    const CableState before = pretensioned(cable);
    const StepView view{tables, rules, before};
    static constexpr int segment = 4;
};

// E1 and E6: what is prescribed at either end is met, and the tensions of both ends have the ratio of all
// wraps.
TEST_F(Candidates, MassMotionMeetsWhatBothEndsPrescribe) {
    double total_wrap_rad = 0.0;
    for (const double wrap_rad : cable.wrap_angle_rad()) total_wrap_rad += wrap_rad;
    const double wraps = std::exp(cable.dynamic_friction() * total_wrap_rad);
    const EndCondition pulled = EndCondition::position_m(-3e-3);
    for (const Direction direction : {Direction::forward, Direction::backward}) {
        const Candidate fixed = taut_mass_motion(view, {pulled, EndCondition::position_m(1e-3)}, direction);
        EXPECT_NEAR(fixed.proximal.displacement_m, -3e-3, 1e-15);
        EXPECT_NEAR(fixed.distal.displacement_m, 1e-3, 1e-15);
        const Candidate loaded = taut_mass_motion(view, {pulled, EndCondition::tension_N(7.0)}, direction);
        EXPECT_NEAR(loaded.distal.tension_N, 7.0, 1e-12);
        const double ratio = direction == Direction::forward ? wraps : 1.0 / wraps;
        EXPECT_NEAR(loaded.proximal.tension_N * ratio, 7.0, 1e-12);
        EXPECT_NEAR(fixed.distal.tension_N / fixed.proximal.tension_N, ratio, 1e-12);
        EXPECT_GT(loaded.distal.displacement_m, loaded.proximal.displacement_m);
    }
}

// E4: a tension that sliding has brought to the edge of the cone is within it, whatever was rounded.
TEST_F(Candidates, FrictionHoldsUpToTheEdgeOfItsConeAndItsRounding) {
    const double edge = view.holding_ratio(segment) * (1.0 + tension_rounding);
    for (const double tension_N : {1.0, 16.0}) {
        EXPECT_TRUE(cone_holds(view, segment, tension_N, tension_N * edge));
        EXPECT_TRUE(cone_holds(view, segment, tension_N * edge, tension_N));
        EXPECT_FALSE(cone_holds(view, segment, tension_N, tension_N * edge * (1.0 + 1e-11)));
        EXPECT_FALSE(cone_holds(view, segment, tension_N * edge * (1.0 + 1e-11), tension_N));
    }
}

// E8, where two sides that slide the same way meet: the same with mu_d.
TEST_F(Candidates, TheMiddleOfASegmentBetweenTwoSidesHoldsUpToTheSameEdge) {
    const int near = segment + 1;
    Candidate met;
    met.pattern = {
        MotionKind::partial, Direction::forward, Direction::forward, near, cable.nodes() - near, 0.0};
    met.proximal.tension_N = met.distal.tension_N = 1.0;
    const double as_one = moving_tension_N(view, met, near - 1) / moving_tension_N(view, met, near);
    for (const double beyond : {0.0, 0.5, 2.0}) {  // of the rounding
        for (const bool rises : {false, true}) {
            const double ratio = tables.sliding_ratio[segment] * (1.0 + beyond * tension_rounding);
            met.distal.tension_N = as_one * (rises ? ratio : 1.0 / ratio);
            EXPECT_NEAR(holding_reserve(view, met), 1.0, 1e-9);
            EXPECT_EQ(resting_nodes_hold(view, met), beyond < 1.0) << beyond;
        }
    }
}

TEST_F(Candidates, ASideWithoutTensionHoldsNothing) {
    Candidate met;
    met.pattern = {MotionKind::partial, Direction::forward, Direction::forward, 5, cable.nodes() - 5, 0.0};
    for (const auto& [proximal_N, distal_N] :
         {std::pair{0.0, 5.0}, {5.0, 0.0}, {-1.0, 5.0}, {5.0, -1.0}, {0.0, 0.0}, {-1.0, -1.0}}) {
        met.proximal.tension_N = proximal_N;
        met.distal.tension_N = distal_N;
        EXPECT_EQ(holding_reserve(view, met), 0.0);
        EXPECT_FALSE(resting_nodes_hold(view, met));
    }
}

}  // namespace
}  // namespace capstan
