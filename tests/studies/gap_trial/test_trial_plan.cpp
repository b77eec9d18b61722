#include <gtest/gtest.h>

#include <map>

#include "capstan/gap_trial/trial_plan.h"

namespace capstan::gap_trial {
namespace {

TEST(TrialPlan, TwoHundredCasesHaveTheStatedMix) {
    TrialOptions options;
    options.cases = 200;
    std::map<TruthGroup, int> groups;
    std::map<std::string, int> effects;
    std::map<Severity, int> severities;
    for (const PlannedCase& planned : plan_trial(options)) {
        ++groups[planned.group];
        if (planned.group == TruthGroup::catalogue) {
            ++effects[planned.makers.front().effect];
            ++severities[planned.severity];
        }
        if (planned.group == TruthGroup::mixture) {
            ASSERT_EQ(planned.makers.size(), 2U);
            EXPECT_NE(effect_family(planned.makers[0].effect), effect_family(planned.makers[1].effect));
        }
    }
    EXPECT_EQ(groups[TruthGroup::none], 20);
    EXPECT_EQ(groups[TruthGroup::foreign], 24);
    EXPECT_EQ(groups[TruthGroup::mixture], 20);
    EXPECT_EQ(groups[TruthGroup::parameter], 18);
    EXPECT_EQ(groups[TruthGroup::catalogue], 118);
    EXPECT_EQ(effects.size(), catalogue_effects().size());
    for (const auto& [effect, count] : effects) {
        EXPECT_GE(count, 5) << effect;
        EXPECT_LE(count, 6) << effect;
    }
    EXPECT_NEAR(severities[Severity::mild], severities[Severity::strong], 12);
}

TEST(TrialPlan, OneGroupAloneWhereOneIsAskedFor) {
    for (const TruthGroup group : {TruthGroup::none, TruthGroup::catalogue, TruthGroup::parameter,
                                   TruthGroup::foreign, TruthGroup::mixture}) {
        EXPECT_EQ(truth_group_named(truth_group_name(group)), group);
        TrialOptions options;
        options.only = group;
        const std::vector<PlannedCase> plan = plan_trial(options);
        EXPECT_EQ(plan.size(), 60U);
        for (const PlannedCase& planned : plan) EXPECT_EQ(planned.group, group);
    }
    EXPECT_FALSE(truth_group_named("whatever"));
}

TEST(TrialPlan, TheSeedDecides) {
    const auto order = [](std::uint64_t seed) {
        TrialOptions options;
        options.seed = seed;
        std::vector<std::string> names;
        for (const PlannedCase& planned : plan_trial(options))
            names.push_back(planned.makers.empty() ? "none" : planned.makers.front().effect);
        return names;
    };
    EXPECT_EQ(order(1), order(1));
    EXPECT_NE(order(1), order(2));
}

TEST(TrialPlan, WithNuisancesWhatEveryBenchHasIsNoCause) {
    TrialOptions options;
    options.cases = 200;
    options.nuisances = true;
    options.mixtures = 0.5;
    int mixtures = 0;
    for (const PlannedCase& planned : plan_trial(options)) {
        mixtures += planned.group == TruthGroup::mixture ? 1 : 0;
        for (const EffectMaker& maker : planned.makers) {
            EXPECT_NE(maker.effect, "sensor_offset");
            EXPECT_NE(maker.effect, "pulley_friction");
        }
    }
    EXPECT_EQ(mixtures, 100);
}

TEST(TrialPlan, OneSeverityWhereOneIsAskedFor) {
    TrialOptions options;
    options.severity = SeverityChoice::mild;
    for (const PlannedCase& planned : plan_trial(options)) {
        if (planned.group != TruthGroup::none) {
            EXPECT_EQ(planned.severity, Severity::mild);
        }
    }
}

TEST(TrialStream, DependsOnlyOnItsAddress) {
    TrialStream one(5, 3, DrawTopic::effect);
    TrialStream same(5, 3, DrawTopic::effect);
    TrialStream other_case(5, 4, DrawTopic::effect);
    TrialStream other_topic(5, 3, DrawTopic::noise);
    const double first = one.normal();
    EXPECT_EQ(first, same.normal());
    EXPECT_NE(first, other_case.normal());
    EXPECT_NE(first, other_topic.normal());
}

TEST(TrialStream, StaysInsideItsLimits) {
    TrialStream draws(1, 1, DrawTopic::plan);
    double mean = 0.0;
    constexpr int count = 4000;
    for (int k = 0; k < count; ++k) {
        const double value = draws.uniform(2.0, 4.0);
        ASSERT_GE(value, 2.0);
        ASSERT_LE(value, 4.0);
        mean += value / count;
        const int integer = draws.integer_below(3);
        ASSERT_GE(integer, 0);
        ASSERT_LE(integer, 2);
    }
    EXPECT_NEAR(mean, 3.0, 0.05);
}

}  // namespace
}  // namespace capstan::gap_trial
