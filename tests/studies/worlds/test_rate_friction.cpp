#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "capstan/worlds/error_table.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::fast_arm;

void add_effect(StudyPlan& plan, const std::string& name, std::vector<double> values) {
    for (std::size_t e = 0; e < effect_catalogue().size(); ++e)
        if (effect_catalogue()[e].name == name) plan.truth.effects[e] = values;
}

struct Fared {
    double mean_abs_N = 0.0;
    double mean_square_N2 = 0.0;
    double covered_fraction = 0.0;
};

Fared fared(const StudyPlan& plan, const std::vector<int>& sensors, int worlds) {
    const WorldQuestion question = world_question(plan);
    Fared sum;
    for (int w = 0; w < worlds; ++w) {
        const auto index = static_cast<std::uint32_t>(w);
        const WorldError error = filter_error(question, question.belief, draw_world(question, index),
                                              ensemble_draws(question, index), sensors);
        sum.mean_abs_N += error.mean_abs_N / worlds;
        sum.mean_square_N2 += error.mean_square_N2 / worlds;
        sum.covered_fraction += error.covered_fraction / worlds;
    }
    return sum;
}

StudyPlan nothing_uncertain(StudyPlan plan) {
    Uncertainty& unknown = plan.uncertainty;
    unknown.friction_fraction = unknown.wrap_fraction = unknown.stiffness_fraction =
        unknown.pretension_fraction = 0.0;
    unknown.far_end = FarEndKind::prescribed;
    unknown.far_end_range_m = 1e-12;
    unknown.members = 16;
    return plan;
}

struct KnownAndNot {
    Fared known;
    Fared unknown;
};

// The same worlds with the effect, for an estimator that knows it and for one that does not.
KnownAndNot fared_with(StudyPlan plan, const std::string& effect, const std::vector<double>& values,
                       const std::vector<int>& sensors, int worlds) {
    add_effect(plan, effect, values);
    KnownAndNot result;
    result.unknown = fared(plan, sensors, worlds);
    plan.uncertainty.known_effects = {effect};
    result.known = fared(plan, sensors, worlds);
    return result;
}

// The bench has bristles and other segments; what is left is its distance from the closed-form step.
TEST(RateFriction, AnEstimatorThatKnowsEverythingFollowsTheBench) {
    const KnownAndNot viscous = fared_with(nothing_uncertain(fast_arm()), "viscous_friction", {200.0}, {}, 1);
    EXPECT_LT(viscous.known.mean_abs_N, 0.07);
    EXPECT_GT(viscous.unknown.mean_abs_N, 2.5 * viscous.known.mean_abs_N);
    const KnownAndNot stribeck =
        fared_with(nothing_uncertain(fast_arm()), "stribeck", {0.05, 0.01, 0.04}, {}, 1);
    EXPECT_LT(stribeck.known.mean_abs_N, 0.07);
    EXPECT_GT(stribeck.unknown.mean_abs_N, 10.0 * stribeck.known.mean_abs_N);
}

// Five times the drag of the fact above: what a step with the last drag would make unstable.
TEST(RateFriction, ALargeDragIsFollowedToo) {
    const KnownAndNot fared = fared_with(nothing_uncertain(fast_arm()), "viscous_friction", {1000.0}, {}, 1);
    EXPECT_LT(fared.known.mean_abs_N, 0.1 * fared.unknown.mean_abs_N);
}

TEST(RateFriction, KnowingItMakesTheErrorSmallerAndTheBandHonest) {
    for (const auto& [effect, values] :
         {std::pair<std::string, std::vector<double>>{"viscous_friction", {200.0}},
          {"stribeck", {0.05, 0.01, 0.04}}}) {
        const KnownAndNot fared = fared_with(fast_arm(), effect, values, {0, 1}, 60);
        EXPECT_LT(fared.known.mean_square_N2, 0.8 * fared.unknown.mean_square_N2) << effect;
        EXPECT_GT(fared.known.covered_fraction, 0.93) << effect;
        EXPECT_LT(fared.known.covered_fraction, 0.97) << effect;
        EXPECT_LT(fared.unknown.covered_fraction, 0.91) << effect;
    }
}

TEST(RateFriction, WithoutSeverityItChangesNoBit) {
    StudyPlan plan = fast_arm();
    const Fared without = fared(plan, {0, 1}, 3);
    plan.uncertainty.known_effects = {"viscous_friction", "stribeck"};
    const Fared known = fared(plan, {0, 1}, 3);
    EXPECT_EQ(known.mean_square_N2, without.mean_square_N2);
    EXPECT_EQ(known.covered_fraction, without.covered_fraction);
}

// A weak drag is a small change, not another algorithm.
TEST(RateFriction, GoesToTheStepWithoutItAsItsSeverityGoesToZero) {
    StudyPlan plan = nothing_uncertain(fast_arm());
    const WorldQuestion question = world_question(plan);
    const World world = draw_world(question, 0);
    const EnsembleDraws draws = ensemble_draws(question, 0);
    CableBelief belief = question.belief;
    const double without_N = filter_error(question, belief, world, draws, {}).mean_abs_N;
    belief.rate_friction.viscous.drag_N_s_per_m2 = 1e-6;
    belief.rate_friction.stribeck.extra_friction = 1e-9;
    EXPECT_NEAR(filter_error(question, belief, world, draws, {}).mean_abs_N, without_N, 1e-5);
}

}  // namespace
}  // namespace capstan
