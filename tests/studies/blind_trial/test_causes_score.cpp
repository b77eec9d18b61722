#include <gtest/gtest.h>

#include <cmath>

#include "capstan/blind_trial/causes_score.h"

namespace capstan::gap_trial {
namespace {

CaseLabel rig(std::vector<std::pair<std::string, double>> effects_and_visibility) {
    CaseLabel label;
    label.name = "case001";
    label.bench = "rig_pair";
    for (const auto& [effect, visibility] : effects_and_visibility) {
        TrueCause cause;
        cause.effect = effect;
        cause.visibility = visibility;
        label.causes.push_back(cause);
    }
    label.nuisances = {{"sensor_offset", "load_torque", 0.01}, {"param_mu", "", 0.1}};
    return label;
}

CaseAnswer said(std::vector<AnsweredEffect> ranked) {
    CaseAnswer answer;
    answer.name = "case001";
    answer.ranked = std::move(ranked);
    return answer;
}

CausesScore score_of(const CaseLabel& label, const CaseAnswer& answer) {
    return score_causes({{&label, &answer}});
}

TEST(CausesScore, NamesByPresenceNotByTheirPartOfTheProbability) {
    // A certain pair shows 0.5 and 0.5, a certain three a third each; the third is named at 0.31.
    const CausesScore score = score_of(
        rig({{"creep", 6.0}, {"backlash", 2.0}, {"stribeck", 0.7}}),
        said({{"creep", 0.4, 0.99}, {"backlash", 0.4, 0.9}, {"stribeck", 0.1, 0.31}, {"none", 0.1}}));
    EXPECT_EQ(score.groups.front().recall.hits, 3);
    EXPECT_EQ(score.groups.front().all_named.hits, 1);
    EXPECT_EQ(score.groups.front().first.hits, 1);
    EXPECT_EQ(score.groups.front().false_names.hits, 0);
}

TEST(CausesScore, WithoutAPresenceTheProbabilityCounts) {
    const CausesScore score = score_of(rig({{"creep", 6.0}, {"backlash", 2.0}}),
                                       said({{"creep", 0.7}, {"backlash", 0.29}, {"inertia", 0.01}}));
    EXPECT_EQ(score.groups.front().recall.hits, 1);
    EXPECT_EQ(score.groups.front().recall.of, 2);
    EXPECT_EQ(score.groups.front().all_named.hits, 0);
}

TEST(CausesScore, NuisancesAreNeitherRightNorWrong) {
    const CausesScore named =
        score_of(rig({{"creep", 6.0}}),
                 said({{"sensor_offset", 0.5, 1.0}, {"creep", 0.3, 0.9}, {"param_mu", 0.2, 0.8}}));
    EXPECT_EQ(named.groups.front().false_names.hits, 0);
    EXPECT_EQ(named.groups.front().first.hits, 1);
    ASSERT_EQ(named.reliability.size(), 1U);
    EXPECT_EQ(named.reliability.front().right.of, 1);
    // A zero that is the cause is one: it follows a condition.
    CaseLabel varying = rig({{"sensor_offset", 3.0}});
    varying.causes.front().varies = "roll_deg";
    const CausesScore cause =
        score_of(varying, said({{"sensor_offset", 0.9, 0.9, "roll_deg"}, {"param_mu", 0.1}}));
    EXPECT_EQ(cause.groups.front().recall.hits, 1);
    EXPECT_EQ(cause.varies.hits, 1);
    EXPECT_EQ(score_of(varying, said({{"sensor_offset", 0.9}})).varies.hits, 0);
}

TEST(CausesScore, NuisancesTakeNoProbabilityFromCauses) {
    const CaseLabel label = rig({{"creep", 6.0}});
    const auto ranked =
        judged(said({{"sensor_offset", 0.5, 1.0}, {"creep", 0.4, 0.9}, {"inertia", 0.1}}), truth_of(label));
    ASSERT_EQ(ranked.size(), 2U);
    EXPECT_NEAR(ranked[0].probability, 0.8, 1e-12);
    EXPECT_NEAR(ranked[1].probability, 0.2, 1e-12);
    EXPECT_EQ(ranked[0].presence(), 0.9);
    EXPECT_EQ(ranked[1].presence(), 0.1);
}

TEST(CausesScore, ANuisanceThatIsSaidToFollowAConditionIsAFalseName) {
    const CausesScore score =
        score_of(rig({{"creep", 6.0}}), said({{"creep", 0.5, 0.9}, {"param_mu", 0.5, 0.8, "roll_deg"}}));
    EXPECT_EQ(score.groups.front().false_names.hits, 1);
    EXPECT_EQ(score.false_varies.hits, 1);
}

TEST(CausesScore, SomethingThatIsNotThereIsAFalseName) {
    const CausesScore score =
        score_of(rig({{"creep", 6.0}}), said({{"creep", 0.6, 0.9}, {"inertia", 0.4, 0.35, "roll_deg"}}));
    EXPECT_EQ(score.groups.front().false_names.hits, 1);
    EXPECT_EQ(score.false_varies.hits, 1);
    EXPECT_EQ(score.false_varies.of, 2);
    // `unknown` is not a name.
    const CausesScore unknown = score_of(rig({{"creep", 6.0}}), said({{"unknown", 0.9}, {"creep", 0.1}}));
    EXPECT_EQ(unknown.groups.front().false_names.hits, 0);
    EXPECT_EQ(unknown.unknown.hits, 1);
    EXPECT_EQ(unknown.groups.front().first.hits, 0);
}

TEST(CausesScore, WhereThereIsNothingNoneIsFirst) {
    EXPECT_EQ(score_of(rig({}), said({{"none", 0.9}})).groups.front().first.hits, 1);
    const CausesScore alarm = score_of(rig({}), said({{"creep", 0.6}, {"none", 0.4}}));
    EXPECT_EQ(alarm.groups.front().first.hits, 0);
    EXPECT_EQ(alarm.groups.front().false_names.hits, 1);
    EXPECT_EQ(alarm.groups.front().all_named.of, 0);
    // Only nuisances named.
    EXPECT_EQ(score_of(rig({}), said({{"param_mu", 1.0}})).groups.front().first.hits, 1);
}

TEST(CausesScore, RecallIsToldByVisibilityAndEffect) {
    const CausesScore score = score_of(rig({{"creep", 6.0}, {"stribeck", 0.7}}),
                                       said({{"creep", 0.9}, {"inertia", 0.02}, {"none", 0.08}}));
    const auto recall = [&](const std::string& by, const std::string& name) {
        for (const CauseGroup& group : score.groups) {
            if (group.by == by && group.name == name) return group.recall.value();
        }
        return -1.0;
    };
    EXPECT_EQ(recall("visibility", "4 and more"), 1.0);
    EXPECT_EQ(recall("visibility", "below 1.5"), 0.0);
    EXPECT_EQ(recall("effect", "stribeck"), 0.0);
    EXPECT_EQ(recall("causes", "2"), 0.5);
    EXPECT_EQ(recall("bench", "rig_pair"), 0.5);
}

TEST(Reliability, WeighsTheGapOfEachBinByItsStatements) {
    Reliability reliability;
    for (int k = 0; k < 8; ++k) reliability.add(0.95, k > 0);  // 7 of 8 right
    reliability.add(0.15, false);
    reliability.add(1.0, true);
    const double high = (8 * 0.95 + 1.0) / 9.0;
    EXPECT_NEAR(reliability.calibration_error(), (9.0 * (high - 8.0 / 9.0) + 0.15) / 10.0, 1e-12);
    ASSERT_EQ(reliability.bins().size(), 2U);
    EXPECT_EQ(reliability.bins().back().right.of, 9);
    EXPECT_LT(reliability.bins().back().right.low(), 8.0 / 9.0);
    EXPECT_EQ(Reliability().calibration_error(), 0.0);
}

// Of n statements of p, k are right with the binomial's probability.
TEST(Reliability, AFewRightProbabilitiesAreOffByChance) {
    for (const double stated : {0.05, 0.5, 0.72, 0.95}) {
        for (const int statements : {1, 2, 7, 40}) {
            Reliability reliability;
            for (int k = 0; k < statements; ++k) reliability.add(stated, false);
            double off = 0.0;
            double probability = std::pow(1.0 - stated, statements);
            for (int right = 0; right <= statements; ++right) {
                off += probability * std::abs(static_cast<double>(right) / statements - stated);
                probability *= (statements - right) / (right + 1.0) * stated / (1.0 - stated);
            }
            EXPECT_NEAR(reliability.calibration_error_by_chance(), off, 1e-12) << stated << " " << statements;
        }
    }
    Reliability certain;
    certain.add(1.0, true);
    EXPECT_EQ(certain.calibration_error_by_chance(), 0.0);
    EXPECT_EQ(Reliability().calibration_error_by_chance(), 0.0);
}

}  // namespace
}  // namespace capstan::gap_trial
