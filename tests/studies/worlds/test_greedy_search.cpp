#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "capstan/storage/study_store.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/choice.h"
#include "capstan/worlds/stored_worlds.h"
#include "capstan/worlds/world_shard.h"
#include "same_answer.h"
#include "scratch_folder.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::expect_the_same_answer;
using testing::ScratchFolder;
using testing::small_plan;

// Seven places, of which three sensors may be had: 63 sets.
StudyPlan seven_places(ComparedSets search) {
    StudyPlan plan = small_plan(3, 60);
    plan.layout_families = {};
    plan.placement.search = search;
    plan.placement.max_sensors = 3;
    return plan;
}

// Up to three sensors at 20 places, found by growing.
StudyPlan many_places() {
    StudyPlan plan = small_plan(3, 20);
    plan.transmission.cable.segments = 19;
    plan.placement.search = ComparedSets::greedy;
    plan.placement.max_sensors = 3;
    return plan;
}

TEST(GreedySearch, IsAsGoodAsAllSetsWithinTheResolution) {
    const WorldAnswer greedy = run_worlds(seven_places(ComparedSets::greedy), {});
    const WorldAnswer all = run_worlds(seven_places(ComparedSets::all), {});
    EXPECT_LT(greedy.candidates.size(), all.candidates.size());
    EXPECT_FALSE(all.bound);
    ASSERT_EQ(greedy.prices.size(), all.prices.size());
    for (std::size_t k = 0; k < all.prices.size(); ++k)
        EXPECT_LE(greedy.prices[k].expected.objective.value_N,
                  all.prices[k].expected.objective.value_N + 2.0 * all.resolution_N)
            << k;
}

// What is claimed of every set holds for each of those that an exhaustive search runs.
TEST(GreedySearch, NoSetIsBetterByMoreThanTheGap) {
    for (const PlacementObjective objective : all_placement_objectives) {
        StudyPlan plan = seven_places(ComparedSets::greedy);
        plan.placement.objective = objective;
        const WorldAnswer greedy = run_worlds(plan, {});
        ASSERT_TRUE(greedy.bound);
        const bool is_of_rms =
            objective == PlacementObjective::worst_node || objective == PlacementObjective::quantile_95;
        EXPECT_EQ(greedy.bound->is_of_rms, is_of_rms);
        plan.placement.search = ComparedSets::all;
        ErrorTable table(plan, {});
        Choice choice(table);
        std::vector<int> sets;
        for (int k = 1; k < choice.candidates(); ++k) sets.push_back(k);
        choice.fill(Condition::as_stated, sets, choice.worlds(), 2 * choice.worlds(), "test");
        const auto error_N = [&](const Expected& expected) {
            return is_of_rms ? expected.rms_N : expected.objective.value_N;
        };
        for (const int set : sets)
            EXPECT_LE(error_N(greedy.best().expected) - error_N(choice.expected(set)),
                      greedy.bound->gap.high_N + 1e-9)
                << words_of(choice.candidate(set), table.offers());
    }
}

TEST(GreedySearch, StandsInForMoreSetsThanCanBeCompared) {
    StudyPlan plan = many_places();
    plan.placement.search = ComparedSets::all;
    plan.placement.max_sensors = 20;  // 2^20 sets
    const WorldAnswer answer = run_worlds(plan, {});
    ASSERT_TRUE(answer.recommended);
    ASSERT_TRUE(answer.bound);
    EXPECT_EQ(answer.set(answer.bound->all.candidate).count(), 20);
    EXPECT_LT(answer.bound->all.rms_N, answer.best().expected.rms_N);
    EXPECT_NE(sentence_of(plan, answer).find("No allowed set is better by more than"), std::string::npos);
    EXPECT_LT(answer.best().expected.objective.value_N, 0.5 * answer.no_sensor.objective.value_N);
}

TEST(GreedySearch, ObeysEveryConstraintAndNeverSellsTheBound) {
    StudyPlan plan = many_places();
    plan.sensors = {{SensorKind::tension, {}, {0.03, 0.1, 0.0, 0.0}, 2.0},
                    {SensorKind::load_torque, {}, {0.03, 0.1, 0.0, 0.0}, 1.0},
                    {SensorKind::load_displacement, {}, {0.0, 1e-4, 0.0, 0.0}, 1.0}};
    plan.placement.budget = 6.0;
    plan.placement.forbidden_m = {0.35, 0.65};
    plan.placement.required_m = {1.0};
    plan.placement.minimum_spacing_m = 0.25;
    const WorldAnswer answer = run_worlds(plan, {});
    ASSERT_GT(answer.candidates.size(), 10U);
    for (std::size_t k = 1; k < answer.candidates.size(); ++k) {
        const Candidate& candidate = answer.candidates[k];
        if (candidate.is_bound) continue;
        EXPECT_LE(candidate.count(), 3);
        EXPECT_LE(candidate.price, 6.0);
        bool has_required = false;
        double before_m = -1.0;
        for (const int sensor : candidate.sensors) {
            const SensorOffer& offer = answer.offers[static_cast<std::size_t>(sensor)];
            has_required =
                has_required || (measures_tension(offer.kind) && std::abs(offer.place_m - 1.0) < 1e-9);
            if (offer.kind != SensorKind::tension) continue;
            EXPECT_TRUE(offer.place_m < 0.35 || offer.place_m > 0.65);
            EXPECT_GE(offer.place_m - before_m, 0.25 - 1e-6);
            before_m = offer.place_m;
        }
        EXPECT_TRUE(has_required) << answer.words(static_cast<int>(k));
    }
    for (const PriceBest& best : answer.prices) EXPECT_FALSE(answer.set(best.expected.candidate).is_bound);
    EXPECT_EQ(answer.prices.front().price, 1.0);  // the load's torque stands at the required place
}

TEST(GreedySearch, IsTheSameForEveryNumberOfThreads) {
    expect_the_same_answer(run_worlds(many_places(), {.jobs = 1}), run_worlds(many_places(), {.jobs = 3}));
}

TEST(GreedySearch, EndsWithTheSameBitsAfterEveryStop) {
    const ScratchFolder folder;
    storage::Database unstopped = storage::Database::open_or_create(folder / "unstopped.db");
    const std::int64_t unstopped_id = begin_worlds(unstopped, many_places(), "test");
    const WorldAnswer answer = run_worlds(unstopped, unstopped_id, many_places(), {});
    storage::Database stopped = storage::Database::open_or_create(folder / "stopped.db");
    const std::int64_t id = begin_worlds(stopped, many_places(), "test");
    int stops = 0;
    for (bool finished = false; !finished;) {
        std::atomic<bool> stop = false;
        int blocks = 0;
        try {
            run_worlds(stopped, id, many_places(),
                       {.on_progress = [&](const TableProgress&) { stop = ++blocks >= 9; }, .stop = &stop});
            finished = true;
        } catch (const TableStopped&) {
            ++stops;
        }
        ASSERT_LT(stops, 1000);
    }
    EXPECT_GT(stops, 1);
    EXPECT_EQ(storage::read_world_errors(stopped, id), storage::read_world_errors(unstopped, unstopped_id));
    EXPECT_EQ(storage::load_study(stopped, id).world_candidates,
              storage::load_study(unstopped, unstopped_id).world_candidates);
    const WorldAnswer read_back = run_worlds(stopped, id, many_places(), {});
    expect_the_same_answer(answer, read_back);
    EXPECT_EQ(answer.trials, read_back.trials);
    EXPECT_EQ(answer.bound->gap.value_N, read_back.bound->gap.value_N);
}

TEST(GreedySearch, EndsWithTheSameBitsInShards) {
    const ScratchFolder folder;
    storage::Database complete = storage::Database::open_or_create(folder / "complete.db");
    const std::int64_t id = begin_worlds(complete, many_places(), "test");
    run_worlds(complete, id, many_places(), {});
    std::vector<std::filesystem::path> files;
    for (int number = 1; number <= 2; ++number) {
        files.push_back(folder / ("shard" + std::to_string(number) + ".db"));
        storage::Database part = storage::Database::open_or_create(files.back(), storage::Journal::rollback);
        run_world_shard(part, many_places(), {number, 2}, "test", {});
    }
    merge_world_shards(folder / "merged.db", files, {});
    storage::Database merged = storage::Database::open_existing(folder / "merged.db");
    EXPECT_EQ(storage::read_world_errors(merged, 1), storage::read_world_errors(complete, id));
    EXPECT_EQ(storage::read_world_recommendation(merged, 1),
              storage::read_world_recommendation(complete, id));
}

}  // namespace
}  // namespace capstan
