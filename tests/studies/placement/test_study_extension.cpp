// A study that was extended is the study that was run with as many repetitions from the start.
#include <gtest/gtest.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/study_extension.h"
#include "capstan/storage/study_store.h"
#include "paper_plan.h"
#include "temporary_study.h"

namespace capstan {
namespace {

StudyPlan plan_with(int repetitions) {
    return test::short_cable_plan(repetitions);
}

StudyToExtend begun_with(storage::Database& database, int repetitions) {
    const std::int64_t id = run_study(database, plan_with(repetitions), "test", {}).study_id;
    return {id, plan_with(repetitions)};
}

/// A small study, and beside it the larger one, run from the start.
test::Dump both_run(int few, int many) {
    test::TemporaryStudy file;
    run_study(file.database(), plan_with(few), "test", {});
    run_study(file.database(), plan_with(many), "test", {});
    return file.dump();
}

// 57 is not a multiple of 40: neither the first blocks nor the last are those of the smaller study.
TEST(StudyExtension, HasTheBitsOfAStudyWithThatNumberFromTheStart) {
    for (const int many : {41, 57, 160}) {
        test::TemporaryStudy file;
        const auto outcome = extend_study(file.database(), begun_with(file.database(), 40), many, "test", {});
        EXPECT_EQ(outcome.run.study_id, 2);
        EXPECT_EQ(outcome.repetitions, many);
        test::expect_same(file.dump(), both_run(40, many));
    }
}

TEST(StudyExtension, ResumedAfterAnyStopEndsWithTheSameBits) {
    const test::Dump expected = both_run(40, 80);
    for (const int units : {0, 1, 3}) {
        test::TemporaryStudy file;
        const StudyToExtend study = begun_with(file.database(), 40);
        std::atomic<bool> stop = units == 0;
        RunOptions options;
        options.stop = &stop;
        options.on_progress = [&](const StudyProgress& progress) { stop = progress.units_done >= units; };
        EXPECT_EQ(extend_study(file.database(), study, 80, "test", options).run.end, RunEnd::stopped);
        EXPECT_EQ(extend_study(file.database(), study, 80, "test", {}).run.end, RunEnd::complete);
        test::expect_same(file.dump(), expected);
    }
}

TEST(StudyExtension, RejectsFewerRepetitionsThanStored) {
    test::TemporaryStudy file;
    const StudyToExtend study = begun_with(file.database(), 40);
    EXPECT_THROW(extend_study(file.database(), study, 40, "test", {}), InvalidInput);
}

// The tolerance is met on all targets or the study goes on; what it ran on the way is gone.
TEST(UntilResolved, DoublesUntilEveryTargetIsResolvedAndKeepsTheLastStudy) {
    test::TemporaryStudy file;
    const StudyToExtend study = begun_with(file.database(), 40);
    const double open_N = unresolved_N(file.database(), study.study_id, 0.025);
    Resolution resolution;
    resolution.tolerance_N = 0.3 * open_N;
    std::vector<int> looked_at;
    resolution.on_look = [&](int repetitions, double) { looked_at.push_back(repetitions); };
    const auto outcome = extend_until_resolved(file.database(), study, resolution, "test", {});
    ASSERT_GE(looked_at.size(), 3u);
    EXPECT_EQ(looked_at[1], 80);
    EXPECT_EQ(looked_at[2], 160);
    EXPECT_EQ(outcome.repetitions, looked_at.back());
    EXPECT_LE(*outcome.unresolved_N, resolution.tolerance_N);
    test::expect_same(file.dump(), both_run(40, outcome.repetitions));
}

TEST(UntilResolved, ResumedAfterAStopEndsWithTheSameStudy) {
    test::TemporaryStudy file;
    const StudyToExtend study = begun_with(file.database(), 40);
    Resolution resolution;
    resolution.tolerance_N = 0.3 * unresolved_N(file.database(), study.study_id, 0.025);
    std::atomic<bool> stop = false;
    int units = 0;
    RunOptions options;
    options.stop = &stop;
    options.on_progress = [&](const StudyProgress&) { stop = ++units > 7; };  // in the second extension
    EXPECT_EQ(extend_until_resolved(file.database(), study, resolution, "test", options).run.end,
              RunEnd::stopped);
    const auto outcome = extend_until_resolved(file.database(), study, resolution, "test", {});
    EXPECT_EQ(outcome.run.end, RunEnd::complete);
    test::expect_same(file.dump(), both_run(40, outcome.repetitions));
}

TEST(UntilResolved, ReportsTheUnresolvedDifferenceAtTheLargestNumberOfRepetitions) {
    test::TemporaryStudy file;
    const StudyToExtend study = begun_with(file.database(), 40);
    Resolution resolution;
    resolution.tolerance_N = 1e-6;
    resolution.max_repetitions = 100;
    const auto outcome = extend_until_resolved(file.database(), study, resolution, "test", {});
    EXPECT_EQ(outcome.repetitions, 80);
    EXPECT_GT(*outcome.unresolved_N, resolution.tolerance_N);
}

// More draws leave less open, and a smaller chance of error leaves more.
TEST(Unresolved, ShrinksWithRepetitionsAndGrowsWithCertainty) {
    test::TemporaryStudy file;
    const auto few = run_study(file.database(), plan_with(80), "test", {}).study_id;
    const auto many = run_study(file.database(), plan_with(2560), "test", {}).study_id;
    EXPECT_LT(unresolved_N(file.database(), many, 0.05), 0.4 * unresolved_N(file.database(), few, 0.05));
    EXPECT_LT(unresolved_N(file.database(), few, 0.05), unresolved_N(file.database(), few, 0.01));
}

}  // namespace
}  // namespace capstan
