#include <gtest/gtest.h>

#include <atomic>

#include "capstan/storage/study_store.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/stored_worlds.h"
#include "same_answer.h"
#include "scratch_folder.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;
using testing::expect_the_same_answer;
using testing::ScratchFolder;

TEST(StoredWorlds, SayTheSameAsARunWithoutADatabase) {
    const ScratchFolder folder;
    storage::Database database = storage::Database::open_or_create(folder / "a.db");
    const std::int64_t id = begin_worlds(database, arm_plan(), "test");
    const WorldAnswer stored = run_worlds(database, id, arm_plan(), {});
    expect_the_same_answer(stored, run_worlds(arm_plan(), {}));
    expect_the_same_answer(stored, run_worlds(database, id, arm_plan(), {}));  // read back
    const auto recommendation = storage::read_world_recommendation(database, id);
    ASSERT_TRUE(recommendation);
    EXPECT_EQ(recommendation->expected_error_N, stored.best().expected.objective.value_N);
    EXPECT_EQ(storage::load_study(database, id).study.status, "complete");
}

TEST(StoredWorlds, EndWithTheSameBitsAfterEveryStop) {
    const ScratchFolder folder;
    storage::Database complete_study = storage::Database::open_or_create(folder / "complete.db");
    const std::int64_t complete_id = begin_worlds(complete_study, arm_plan(), "test");
    run_worlds(complete_study, complete_id, arm_plan(), {});
    storage::Database stopped = storage::Database::open_or_create(folder / "stopped.db");
    const std::int64_t id = begin_worlds(stopped, arm_plan(), "test");
    int stops = 0;
    for (bool complete = false; !complete;) {
        std::atomic<bool> stop = false;
        int blocks = 0;
        try {
            run_worlds(stopped, id, arm_plan(),
                       {.on_progress = [&](const TableProgress&) { stop = ++blocks >= 9; }, .stop = &stop});
            complete = true;
        } catch (const TableStopped&) {
            ++stops;
        }
        ASSERT_LT(stops, 1000);
    }
    EXPECT_GT(stops, 1);
    EXPECT_EQ(storage::read_world_errors(stopped, id),
              storage::read_world_errors(complete_study, complete_id));
    EXPECT_EQ(storage::read_world_recommendation(stopped, id),
              storage::read_world_recommendation(complete_study, complete_id));
}

}  // namespace
}  // namespace capstan
