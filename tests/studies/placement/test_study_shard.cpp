// What a shard owns depends on nothing but the plans and the number of shards.
#include <gtest/gtest.h>

#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/study_cost.h"
#include "capstan/placement/study_shard.h"
#include "capstan/plan/study_plan.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"
#include "paper_plan.h"
#include "temporary_study.h"

namespace capstan {
namespace {

// Four noise levels in all, of 4 and of 3 instants.
TEST(Deal, KeepsTheInstantsOfANoiseLevelTogetherWhileThereAreEnough) {
    const std::vector<StudySize> studies{{3, 4}, {1, 3}};
    for (const int shards : {1, 2, 3, 4}) {
        const Deal deal(studies, shards);
        int level = 0;
        for (std::size_t k = 0; k < studies.size(); ++k) {
            for (int noise = 0; noise < studies[k].noise_levels; ++noise, ++level) {
                for (int s = 0; s < studies[k].instants; ++s) {
                    EXPECT_EQ(deal.owner(k, noise, s), level % shards + 1);
                }
            }
        }
    }
}

TEST(Deal, DealsPartsEvenlyAmongShards) {
    const std::vector<StudySize> studies{{3, 4}, {1, 3}};
    for (const int shards : {5, 8, 15}) {
        const Deal deal(studies, shards);
        std::vector<int> parts(shards, 0);
        for (std::size_t k = 0; k < studies.size(); ++k) {
            for (int noise = 0; noise < studies[k].noise_levels; ++noise) {
                for (int s = 0; s < studies[k].instants; ++s) ++parts.at(deal.owner(k, noise, s) - 1);
            }
        }
        for (const int owned : parts) {
            EXPECT_GE(owned, 15 / shards);
            EXPECT_LE(owned, (15 + shards - 1) / shards);
        }
    }
}

TEST(Shard, PartsAreInstantsTimesNoiseLevels) {
    const std::vector<StudyPlan> plans{test::small_plan(2), test::paper_plan(2)};
    EXPECT_EQ(parts_of({plans.data(), 1}), 8);
    EXPECT_EQ(parts_of(plans), 12);
    EXPECT_NO_THROW(require_useful(plans, {1, 12}));
    EXPECT_THROW(require_useful(plans, {1, 13}), InvalidInput);
}

// Three noise levels and five shards, so parts are dealt: shard 4 owns parts 3 and 8, the first of the second
// study.
TEST(Shard, RunsOnlyItsOwnUnitsOfEveryStudy) {
    const std::vector<StudyPlan> plans{test::small_plan(2), test::paper_plan(2)};
    test::TemporaryStudy file;
    run_shard(file.database(), plans, {4, 5}, "test", {});
    const auto pending = [&](std::int64_t id) {
        const auto units = storage::pending_units(file.database(), id);
        return std::set<int>(units.begin(), units.end());
    };
    EXPECT_EQ(pending(1), (std::set<int>{0, 1, 2, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15}));  // not 3, 7
    EXPECT_EQ(pending(2), (std::set<int>{1, 2, 3, 5, 6, 7}));                                // not 0, 4
}

TEST(Shard, RejectsAFileOfCompleteStudies) {
    const std::vector<StudyPlan> plans{test::small_plan(2)};
    test::TemporaryStudy file;
    run_study(file.database(), plans[0], "test", {});
    const auto before = file.dump();
    EXPECT_THROW(run_shard(file.database(), plans, {1, 2}, "test", {}), storage::Error);
    EXPECT_TRUE(file.dump() == before);
}

// Weights come from the two instants in mass motion; one part a shard: of the 4 shards at a noise level the
// two with mass motion lack one of them, the others both.
TEST(Shard, CountsTheReadingsSolvedAgainForWeights) {
    std::vector<StudyPlan> plans{test::small_plan(2)};
    EXPECT_EQ(parts_solved_again(plans, 1), 0);
    EXPECT_EQ(parts_solved_again(plans, 2), 0);  // a noise level each
    EXPECT_EQ(parts_solved_again(plans, 8), 2 * (1 + 1 + 2 + 2));
    plans[0].weight_source = WeightSource::same_regime;
    EXPECT_EQ(parts_solved_again(plans, 8), 2 * 4);
}

TEST(Sweep, IsAStudyForEveryCombination) {
    StudyPlan plan = test::paper_plan(2);
    plan.sweep.friction_ratio = {0.5, 1.0};
    plan.sweep.curvature_ratio = {2.0};
    plan.sweep.stiffness_ratio = {1.0, 3.0};
    plan.sweep.segments = {10, 20};
    const std::vector<StudyPlan> studies = studies_in_sweep(plan);
    ASSERT_EQ(studies.size(), 8u);
    std::set<std::string> names;
    for (const StudyPlan& study : studies) {
        names.insert(study.name);
        EXPECT_FALSE(study.sweep.is_there());
        EXPECT_EQ(study.seed, plan.seed);
        EXPECT_DOUBLE_EQ(study.transmission.cable.curvature.front().bend_radius_m, 0.14);
    }
    EXPECT_EQ(names.size(), 8u);
    EXPECT_DOUBLE_EQ(studies.front().transmission.cable.dynamic_friction, 0.105);
    EXPECT_DOUBLE_EQ(studies.front().transmission.cable.static_friction, 0.315);
    EXPECT_DOUBLE_EQ(studies.back().transmission.cable.axial_stiffness_N, 6000.0);
    EXPECT_EQ(studies.back().transmission.cable.segments, 20);
    EXPECT_EQ(studies.back().sensor_counts.size(), 21u);  // "all" counts stay all
}

TEST(Sweep, ChoosesInstantsInTheirRegime) {
    StudyPlan plan = test::paper_plan(2);
    plan.sweep.friction_ratio = {0.25, 0.5, 1.0};
    plan.sweep.instants_per_regime = 5;
    for (const StudyPlan& study : studies_in_sweep(plan)) {
        EXPECT_TRUE(problems_of(study).empty()) << problems_of(study).front().text();
        for (const RegimeInstants& regime : study.regimes) {
            EXPECT_EQ(std::set<int>(regime.samples.begin(), regime.samples.end()).size(), 5u);
        }
    }
}

TEST(Sweep, NamesTheStudyThatNeverReachesARegime) {
    StudyPlan plan = test::paper_plan(2);
    plan.motion.proximal.amplitude = 1e-5;  // nothing moves but the first nodes
    plan.sweep.segments = {12};
    plan.sweep.instants_per_regime = 1;
    try {
        studies_in_sweep(plan);
        FAIL() << "no refusal";
    } catch (const InvalidInput& error) {
        EXPECT_NE(
            error.problems().front().find("'paper: 12 segments' the motion is never in the regime mass"),
            std::string::npos)
            << error.problems().front();
    }
}

TEST(Sweep, PlanWithoutASweepIsItsOnlyStudy) {
    const StudyPlan plan = test::paper_plan(2);
    const std::vector<StudyPlan> studies = studies_in_sweep(plan);
    ASSERT_EQ(studies.size(), 1u);
    EXPECT_EQ(studies.front().name, plan.name);
    EXPECT_EQ(studies.front().regimes.front().samples, plan.regimes.front().samples);
}

}  // namespace
}  // namespace capstan
