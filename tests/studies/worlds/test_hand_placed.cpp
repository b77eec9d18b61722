#include <gtest/gtest.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/hand_placed.h"
#include "capstan/worlds/stored_worlds.h"
#include "scratch_folder.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;
using testing::ScratchFolder;

class PlacedByHand : public ::testing::Test {
  protected:
    ScratchFolder folder;
    storage::Database database = storage::Database::open_or_create(folder / "study.db");
    const std::int64_t id = begin_worlds(database, arm_plan(), "test");
    const WorldAnswer answer = run_worlds(database, id, arm_plan(), {});
    HandPlacer placer{database, id, arm_plan()};
};

TEST_F(PlacedByHand, ASetOfTheStudyGetsTheBitsOfTheStudy) {
    ASSERT_TRUE(answer.recommended);
    for (const PriceBest& best : answer.prices) {
        const HandPlaced placed = placer.judge(answer.set(best.expected.candidate).sensors);
        EXPECT_EQ(placed.expected.objective.value_N, best.expected.objective.value_N);
        EXPECT_EQ(placed.expected.objective.low_N, best.expected.objective.low_N);
        EXPECT_EQ(placed.expected.error_95_N, best.expected.error_95_N);
        EXPECT_TRUE(placed.is_allowed);
    }
    const HandPlaced recommended = placer.judge(answer.set(answer.best().expected.candidate).sensors);
    EXPECT_EQ(recommended.gain_over_none.value_N, answer.gain_over_none.value_N);
    EXPECT_EQ(recommended.worse_than_recommended.value_N, 0.0);
    EXPECT_FALSE(recommended.is_distinguished());
}

TEST_F(PlacedByHand, ASetThatTheStudyDidNotCompareIsRunInItsWorldsAndNotStored) {
    const auto before = storage::read_world_errors(database, id);
    const HandPlaced placed = placer.judge({4, 3, 2});  // in any order
    EXPECT_EQ(placed.set.sensors, (std::vector<int>{2, 3, 4}));
    EXPECT_GT(placed.gain_over_none.value_N, 0.0);
    EXPECT_EQ(storage::read_world_errors(database, id), before);
    // A study that compares this set as a named one says the same of it.
    StudyPlan named = arm_plan();
    named.explicit_layouts = {{2, 3, 4}};
    ErrorTable table(named, {});
    const std::vector<int> set = {table.candidate_of({2, 3, 4})};
    table.fill(Condition::as_stated, set, named.repetitions, 2 * named.repetitions, "test");
    double mean_N = 0.0;
    for (int world = named.repetitions; world < 2 * named.repetitions; ++world)
        mean_N += table.at(Condition::as_stated, set.front(), world).mean_abs_N / named.repetitions;
    EXPECT_DOUBLE_EQ(placed.expected.objective.value_N, mean_N);
}

TEST_F(PlacedByHand, OneSensorAtTheMotorIsToldFromTheRecommendedSet) {
    const HandPlaced placed = placer.judge({0});
    EXPECT_TRUE(placed.is_distinguished());
    EXPECT_GT(placed.worse_than_recommended.low_N, 0.0);
}

TEST_F(PlacedByHand, WhatIsNotOnOfferIsRefused) {
    EXPECT_THROW(placer.judge({}), InvalidInput);
    EXPECT_THROW(placer.judge({1, 1}), InvalidInput);
    EXPECT_THROW(placer.judge({-1}), InvalidInput);
    EXPECT_THROW(placer.judge({11}), InvalidInput);
}

}  // namespace
}  // namespace capstan
