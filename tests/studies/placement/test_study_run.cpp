// Whatever the threads do, and however often a study is stopped, the tables hold the same bits.
#include <gtest/gtest.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/replay.h"
#include "capstan/storage/study_store.h"
#include "paper_plan.h"
#include "temporary_study.h"

namespace capstan {
namespace {

using test::Dump;
using test::TemporaryStudy;

RunOptions with_jobs(int jobs) {
    RunOptions options;
    options.jobs = jobs;
    return options;
}

const Dump& uninterrupted() {
    static const Dump dump = [] {
        TemporaryStudy study;
        run_study(study.database(), test::small_plan(40), "test", with_jobs(1));
        return study.dump();
    }();
    return dump;
}

TEST(StudyRun, FillsEveryTableOfItsResults) {
    const Dump& dump = uninterrupted();
    for (const char* table : {"study", "scenario", "single_sensor", "single_sensor_node", "sensor_weight",
                              "cell", "cell_node", "cell_block", "known_direction_bound", "recommendation"}) {
        EXPECT_FALSE(dump.at(table).empty()) << table;
    }
}

TEST(StudyRun, AnyNumberOfThreadsGivesTheSameBits) {
    for (const int jobs : {2, 7, 16}) {
        TemporaryStudy study;
        run_study(study.database(), test::small_plan(40), "test", with_jobs(jobs));
        SCOPED_TRACE(std::to_string(jobs) + " jobs");
        test::expect_same(study.dump(), uninterrupted());
    }
}

// 4 scenarios x 2 noise levels x 2 stages are 16 units; 15 leaves one, 16 only the conclusions.
TEST(StudyRun, ResumedAfterAStopEndsWithTheSameBits) {
    const StudyPlan plan = test::small_plan(40);
    for (const int units : {0, 1, 4, 6, 11, 15}) {
        SCOPED_TRACE("stopped after " + std::to_string(units) + " units");
        TemporaryStudy study;
        std::atomic<bool> stop = false;
        RunOptions options = with_jobs(2);
        options.stop = &stop;
        options.on_progress = [&](const StudyProgress& progress) { stop = progress.units_done >= units; };
        const RunOutcome first = run_study(study.database(), plan, "test", options);
        ASSERT_EQ(first.end, RunEnd::stopped);
        EXPECT_EQ(storage::pending_units(study.database(), first.study_id).size(), 16u - units);

        const RunOutcome rest = resume_study(study.database(), first.study_id, plan, with_jobs(1));
        EXPECT_EQ(rest.end, RunEnd::complete);
        test::expect_same(study.dump(), uninterrupted());
    }
}

TEST(StudyRun, ResumedAfterTwoStopsEndsWithTheSameBits) {
    const StudyPlan plan = test::small_plan(40);
    TemporaryStudy study;
    std::atomic<bool> stop = false;
    int last = 3;
    RunOptions options = with_jobs(1);
    options.stop = &stop;
    options.on_progress = [&](const StudyProgress& progress) { stop = progress.units_done >= last; };
    const std::int64_t id = run_study(study.database(), plan, "test", options).study_id;
    stop = false;
    last = 9;
    EXPECT_EQ(resume_study(study.database(), id, plan, options).end, RunEnd::stopped);
    EXPECT_EQ(resume_study(study.database(), id, plan, with_jobs(1)).end, RunEnd::complete);
    test::expect_same(study.dump(), uninterrupted());
}

TEST(StudyRun, ReportsProgressUpToTheLastUnit) {
    TemporaryStudy study;
    std::vector<int> done;
    RunOptions options = with_jobs(1);
    options.on_progress = [&](const StudyProgress& progress) {
        EXPECT_EQ(progress.units, 16);
        done.push_back(progress.units_done);
    };
    run_study(study.database(), test::small_plan(2), "test", options);
    ASSERT_EQ(done.size(), 17u);
    for (int k = 0; k <= 16; ++k) EXPECT_EQ(done[k], k);
}

TEST(StudyRun, WritesNothingForAPlanWithProblems) {
    TemporaryStudy study;
    StudyPlan plan = test::small_plan(40);
    plan.sensor_counts = {12};
    EXPECT_THROW(run_study(study.database(), plan, "test", {}), InvalidInput);
    EXPECT_TRUE(study.dump().at("study").empty());
}

// Errors of the repetitions, replayed one by one and averaged, against the stored mean of the cell.
TEST(Replay, ReproducesTheRepetitionsOfTheStudy) {
    constexpr int repetitions = 6;
    const StudyPlan plan = test::small_plan(repetitions);
    TemporaryStudy study;
    const std::int64_t id = run_study(study.database(), plan, "test", with_jobs(2)).study_id;
    const auto description = storage::load_study(study.database(), id);
    for (int scenario = 0; scenario < 4; ++scenario) {
        for (int noise = 0; noise < 2; ++noise) {
            std::vector<Replay> replays;
            for (int r = 0; r < repetitions; ++r) replays.push_back(replay(plan, {scenario, noise, r}, 1));
            const auto stored = storage::read_fusion(study.database(), id, scenario, noise);
            const std::size_t methods = description.fusion_methods.size();
            ASSERT_EQ(replays[0].estimates.size(), description.layouts.size() * methods);
            for (std::size_t k = 0; k < replays[0].estimates.size(); ++k) {
                double mean_N = 0.0;
                for (const Replay& one : replays) mean_N += one.estimates[k].mean_abs_error_N / repetitions;
                const int set = description.layouts[k / methods].set_index;
                const storage::CellRecord& cell = stored.cells[set * methods + k % methods];
                ASSERT_EQ(cell.method, replays[0].estimates[k].method);
                EXPECT_NEAR(mean_N, cell.mean_abs_error_N, 1e-12) << replays[0].estimates[k].layout;
            }
        }
    }
}

TEST(Replay, RejectsAnAddressOutsideTheStudy) {
    const StudyPlan plan = test::small_plan(6);
    EXPECT_THROW(replay(plan, {4, 0, 0}, 1), InvalidInput);
    EXPECT_THROW(replay(plan, {0, 2, 0}, 1), InvalidInput);
    EXPECT_THROW(replay(plan, {0, 0, 6}, 1), InvalidInput);
    EXPECT_THROW(replay(plan, {-1, 0, 0}, 1), InvalidInput);
}

TEST(PreparedStudy, NamesEachSetOfNodesOnce) {
    const StudyPlan plan = test::paper_plan(2);
    const PreparedStudy study = prepare(plan);
    for (std::size_t a = 0; a < study.sensor_sets.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) EXPECT_NE(study.sensor_sets[a], study.sensor_sets[b]);
    }
    for (const PlannedLayout& planned : study.layouts) {
        EXPECT_EQ(study.sensor_sets[planned.set_index], planned.layout.nodes) << planned.layout.label;
    }
}

}  // namespace
}  // namespace capstan
