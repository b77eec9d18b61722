// Short cable, few draws: what is asked is whether the answer says what it means.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/sensitivity/advice_sensitivity.h"
#include "capstan/sensitivity/uncertain_parameter.h"
#include "paper_plan.h"

namespace capstan::sensitivity {
namespace {

StudyPlan plan_for(int sensors) {
    StudyPlan plan = test::short_cable_plan(200);
    plan.fusion_methods = {"mean", "w_mean", "maximum_likelihood"};
    plan.sensitivity.sensors = sensors;
    plan.sensitivity.repetitions = 200;
    plan.sensitivity.trajectories = 3;
    return plan;
}

std::size_t index_of(const std::string& name) {
    for (std::size_t p = 0; p < uncertain_parameters().size(); ++p) {
        if (uncertain_parameters()[p].name == name) return p;
    }
    return 99;
}

TEST(UncertainParameters, ScaleTheNamedParameter) {
    const StudyPlan plan = plan_for(2);
    const std::vector<double> ratio = {1.1, 0.9, 1.2, 0.8, 2.0};
    const auto scaled = plan_with(plan, 0, ratio);
    ASSERT_TRUE(scaled);
    for (std::size_t p = 0; p < ratio.size(); ++p) {
        const UncertainParameter& parameter = uncertain_parameters()[p];
        const double expected =
            parameter.name == "noise" ? 2.0 * 0.8 : ratio[p];  // it grows with the tension
        EXPECT_NEAR(parameter.value(*scaled, 0) / parameter.value(plan, 0), expected, 1e-12)
            << parameter.name;
    }
}

TEST(UncertainParameters, InstantsFollowTheirRegime) {
    const StudyPlan plan = plan_for(2);
    const auto same = plan_with(plan, 0, {1, 1, 1, 1, 1});
    for (std::size_t r = 0; r < plan.regimes.size(); ++r)
        EXPECT_EQ(same->regimes[r].samples, plan.regimes[r].samples);
    for (const double friction : {0.6, 1.5}) {
        const auto scaled = plan_with(plan, 0, {friction, 1, 1, 1, 1});
        ASSERT_TRUE(scaled);
        EXPECT_TRUE(problems_of(*scaled).empty());
    }
}

// Almost without friction the complete cable moves at once, so no instant of partial motion remains.
TEST(UncertainParameters, DistributesTheFractionOfAnAbsentRegime) {
    const auto scaled = plan_with(plan_for(2), 0, {1e-9, 1, 1, 1, 1});
    ASSERT_TRUE(scaled);
    double fraction = 0.0;
    for (const RegimeInstants& regime : scaled->regimes) fraction += regime.duty_fraction;
    EXPECT_NEAR(fraction, 1.0, 1e-12);
}

TEST(AdviceQuestion, TheBestLayoutHasNoRegret) {
    const StudyPlan plan = plan_for(2);
    const auto there = AdviceQuestion(plan, 0).ask({1, 1, 1, 1, 1}, nullptr);
    ASSERT_TRUE(there);
    EXPECT_EQ(there->best.nodes.size(), 2u);
    EXPECT_EQ(there->regret.value_N, 0.0);
    EXPECT_EQ(there->regret.high_N, 0.0);
}

TEST(AdviceQuestion, AWorseLayoutHasRegret) {
    const StudyPlan plan = plan_for(1);
    const Advice proximal{{0}, "mean"};
    const auto there = AdviceQuestion(plan, 0).ask({1, 1, 1, 1, 1}, &proximal);
    EXPECT_GT(there->regret.low_N, 0.1);
}

TEST(AdviceQuestion, KeepsToConstraintsAndMethod) {
    StudyPlan plan = plan_for(2);
    plan.placement.forbidden_nodes = {4};
    plan.sensitivity.method = "mean";
    const auto there = AdviceQuestion(plan, 0).ask({1, 1, 1, 1, 1}, nullptr);
    EXPECT_EQ(there->best.method, "mean");
    EXPECT_EQ(std::count(there->best.nodes.begin(), there->best.nodes.end(), 4), 0);
}

TEST(AdviceQuestion, RefusesWhatItCannotAnswer) {
    StudyPlan plan = plan_for(2);
    plan.sensitivity.friction_ratio = {1.2, 1.5};
    EXPECT_THROW(AdviceQuestion(plan, 0), InvalidInput) << "the configured value is outside the range";
    plan = plan_for(6);
    EXPECT_THROW(AdviceQuestion(plan, 0), InvalidInput) << "more sensors than nodes";
    plan = plan_for(2);
    plan.sensitivity.method = "posterior_mean";
    EXPECT_THROW(AdviceQuestion(plan, 0), InvalidInput) << "a method that the study does not use";
    plan = plan_for(2);
    plan.sensitivity.regime = "partial_distal";
    EXPECT_THROW(AdviceQuestion(plan, 0), InvalidInput) << "a regime that the study does not have";
}

// Asked again, the advice holds at the last value said to hold and not at the first said not to.
TEST(AdviceSensitivity, FlipsAtTheStatedValueAndHoldsBefore) {
    StudyPlan plan = plan_for(1);
    plan.sensitivity.method = "mean";
    plan.sensitivity.regime = "mass";
    plan.sensitivity.tolerance_N = 0.002;
    const SensitivityAnswer answer = advice_sensitivity(plan, {});
    const AdviceQuestion question(plan, 0);
    int flips = 0;
    for (const ParameterSensitivity& parameter : answer.parameters) {
        for (const auto& flip : {parameter.flip_below, parameter.flip_above}) {
            if (!flip) continue;
            ++flips;
            std::vector<double> ratio(5, 1.0);
            ratio[index_of(parameter.name)] = flip->ratio;
            EXPECT_GT(question.ask(ratio, &answer.advice)->regret.value_N, 0.002);
            ratio[index_of(parameter.name)] = flip->held_ratio;
            EXPECT_LE(question.ask(ratio, &answer.advice)->regret.value_N, 0.002);
            EXPECT_NEAR(std::log(flip->ratio / flip->held_ratio), 0.0, 0.01);
        }
    }
    RecordProperty("flips", flips);
}

TEST(AdviceSensitivity, TheScanIncludesTheConfiguredValueWithoutRegret) {
    const SensitivityAnswer answer = advice_sensitivity(plan_for(2), {});
    ASSERT_EQ(answer.parameters.size(), 5u);
    for (const ParameterSensitivity& parameter : answer.parameters) {
        EXPECT_EQ(parameter.scan.size(), 13u);
        EXPECT_TRUE(std::is_sorted(parameter.scan.begin(), parameter.scan.end(),
                                   [](const ScanPoint& a, const ScanPoint& b) { return a.ratio < b.ratio; }));
        EXPECT_EQ(parameter.scan[6].ratio, 1.0);
        EXPECT_EQ(parameter.scan[6].there->regret.value_N, 0.0);
        EXPECT_GE(parameter.on_error.steps + answer.never, 3);
    }
    EXPECT_EQ(answer.screened, 3 * 6);
}

// More noise, more error: the one effect of which the sign is known.
TEST(AdviceSensitivity, NoiseRaisesTheError) {
    for (const ParameterSensitivity& parameter : advice_sensitivity(plan_for(2), {}).parameters) {
        if (parameter.name != "noise") continue;
        EXPECT_GT(parameter.on_error.mean, 0.0);
    }
}

TEST(AdviceSensitivity, ACertainParameterIsLeftOut) {
    StudyPlan plan = plan_for(1);
    plan.sensitivity.friction_ratio = plan.sensitivity.curvature_ratio = plan.sensitivity.stiffness_ratio =
        plan.sensitivity.pretension_ratio = {1.0, 1.0};
    const SensitivityAnswer answer = advice_sensitivity(plan, {});
    ASSERT_EQ(answer.parameters.size(), 1u);
    EXPECT_EQ(answer.parameters[0].name, "noise");
    plan.sensitivity.noise_ratio = {1.0, 1.0};
    EXPECT_THROW(advice_sensitivity(plan, {}), InvalidInput);
}

}  // namespace
}  // namespace capstan::sensitivity
