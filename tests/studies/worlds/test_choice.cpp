#include <gtest/gtest.h>

#include <cmath>

#include "capstan/worlds/choice.h"
#include "capstan/worlds/stored_worlds.h"
#include "same_answer.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;
using testing::expect_the_same_answer;

TEST(SensorChoice, IsTheSameForEveryNumberOfThreads) {
    expect_the_same_answer(run_worlds(arm_plan(), {.jobs = 1}), run_worlds(arm_plan(), {.jobs = 3}));
}

TEST(SensorChoice, NothingThatIsRecommendedIsWorseThanNoSensor) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        StudyPlan plan = arm_plan();
        plan.seed = seed;
        const WorldAnswer answer = run_worlds(plan, {});
        ASSERT_TRUE(answer.recommended);
        EXPECT_LT(answer.best().expected.objective.value_N, answer.no_sensor.objective.value_N);
        EXPECT_GT(answer.gain_over_none.low_N, 0.0);
    }
}

// What is recommended where no sensor, one and three have these errors.
int recommended_sensors(double one_N, double three_N) {
    StudyPlan plan = arm_plan();
    plan.layout_families = {"distal"};
    plan.sensor_counts = {1, 3};
    plan.worthwhile_gain_N = 0.02;
    ErrorTable table(plan, {});
    const double errors_N[] = {1.0, one_N, three_N};
    for (int candidate = 0; candidate < 3; ++candidate) {
        for (int world = 0; world < 2 * plan.repetitions; ++world) {
            WorldError error;
            error.mean_abs_N = errors_N[candidate] * (1.0 + 0.01 * std::sin(world));
            table.take({Condition::as_stated, candidate, world, error});
        }
    }
    Choice choice(table);
    const WorldAnswer answer = choose_of_each_price(choice);
    return answer.recommended ? answer.set(answer.best().expected.candidate).count() : 0;
}

TEST(SensorChoice, EachOfSeveralFurtherSensorsMustBeWorthItsPrice) {
    EXPECT_EQ(recommended_sensors(0.5, 0.45), 3);  // 0.025 N each, where 0.02 N are asked
    EXPECT_EQ(recommended_sensors(0.5, 0.47), 1);  // 0.015 N each
    EXPECT_EQ(recommended_sensors(1.01, 0.95), 0);
}

TEST(SensorChoice, ASensorThatTellsNothingIsNotRecommended) {
    StudyPlan plan = arm_plan();
    plan.noise_levels.front().level = {.multiplicative_ratio = 50.0, .additive_N = 5000.0};
    const WorldAnswer answer = run_worlds(plan, {});
    EXPECT_FALSE(answer.recommended);
    EXPECT_NE(sentence_of(plan, answer).find("No set of sensors is better than none"), std::string::npos);
}

// What one more sensor does to the squared error is the law that a Bayesian estimator obeys.
TEST(SensorChoice, AFurtherSensorNeverRaisesTheSquaredError) {
    ErrorTable table(arm_plan(), {});
    const auto& candidates = table.candidates();
    constexpr int worlds = 60;
    std::vector<int> all;
    for (int k = 0; k < static_cast<int>(candidates.size()); ++k) all.push_back(k);
    table.fill(Condition::as_stated, all, 0, worlds, "test");
    int pairs = 0;
    for (int a = 0; a < static_cast<int>(candidates.size()); ++a) {
        for (int b = 0; b < static_cast<int>(candidates.size()); ++b) {
            const auto& fewer = candidates[a].sensors;
            const auto& more = candidates[b].sensors;
            if (fewer.size() >= more.size() ||
                !std::includes(more.begin(), more.end(), fewer.begin(), fewer.end()))
                continue;
            ++pairs;
            double mean = 0.0, squares = 0.0, before = 0.0;
            for (int w = 0; w < worlds; ++w) {
                const double rise = table.at(Condition::as_stated, b, w).mean_square_N2 -
                                    table.at(Condition::as_stated, a, w).mean_square_N2;
                mean += rise / worlds;
                squares += rise * rise / worlds;
                before += table.at(Condition::as_stated, a, w).mean_square_N2 / worlds;
            }
            const double error = std::sqrt((squares - mean * mean) / (worlds - 1));
            EXPECT_LT(mean, std::max(3.0 * error, 0.02 * before)) << a << " to " << b;
        }
    }
    EXPECT_GT(pairs, 10);
}

TEST(SensorChoice, TheBandHoldsTheTruthAsOftenAsItSays) {
    ErrorTable table(arm_plan(), {});
    constexpr int worlds = 60;
    const std::vector<int> some = {0, 1, static_cast<int>(table.candidates().size()) - 1};
    table.fill(Condition::as_stated, some, 0, worlds, "test");
    for (const int candidate : some) {
        double covered = 0.0;
        for (int w = 0; w < worlds; ++w)
            covered += table.at(Condition::as_stated, candidate, w).covered_fraction / worlds;
        EXPECT_GT(covered, 0.90) << candidate;
        EXPECT_LT(covered, 0.98) << candidate;
    }
}

// From their own estimates and with the nominal cable, they know neither friction nor the far end.
TEST(SensorChoice, ThePapersFourMethodsRunOverTimeAndErrMoreThanTheFilter) {
    const WorldAnswer answer = run_worlds(arm_plan(), {});
    ASSERT_EQ(answer.paper.size(), 4U);
    EXPECT_EQ(answer.paper[2].condition, Condition::paper_w_mean);
    for (const PaperComparison& each : answer.paper) {
        EXPECT_TRUE(std::isfinite(each.error.value_N));
        EXPECT_GT(each.error.value_N, answer.best().expected.objective.value_N) << name_of(each.condition);
    }
    EXPECT_NE(answer.paper[0].error.value_N, answer.paper[2].error.value_N);
}

TEST(SensorChoice, ASensorWithMoreNoiseWeighsLess) {
    StudyPlan plan = arm_plan();
    plan.sensors = {{SensorKind::tension, {1.0}, {0.03, 0.1, 0.0, 0.0}, 1.0},
                    {SensorKind::tension, {1.0}, {0.5, 5.0, 0.0, 0.0}, 1.0}};
    const WorldQuestion question = world_question(plan);
    EXPECT_GT(paper_weight(question, 0), 1.2 * paper_weight(question, 1));
}

// What is assumed has the range of the log; with a log of one stretch all worlds share it.
TEST(SensorChoice, WithARecordedFarEndSensorsHelpAndTheBandIsHonest) {
    StudyPlan plan = arm_plan();
    plan.uncertainty.far_end = FarEndKind::recorded;
    for (int k = 0; k < 3000; ++k)
        plan.uncertainty.far_end_samples_m.push_back(0.0005 *
                                                     (std::sin(0.043 * k) + std::sin(0.071 * k + 1.0)));
    const WorldAnswer answer = run_worlds(plan, {});
    ASSERT_TRUE(answer.recommended);
    EXPECT_GT(answer.best().expected.covered_fraction, 0.90);
}

}  // namespace
}  // namespace capstan
