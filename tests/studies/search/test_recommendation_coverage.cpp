// 400 independent small studies, from plan to stored recommendation, against the errors that 40,000
// repetitions give. Sensors are biased, so that the instants of a repetition are off together. Seeds and
// counts are fixed.
#include <gtest/gtest.h>

#include <map>

#include "capstan/placement/recommendation.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/storage/study_store.h"
#include "every_layout.h"
#include "temporary_study.h"

namespace capstan {
namespace {

using test::coverage_studies;
using test::Tally;

// Without W methods: their weights come from each study's own draws, so each study has a truth of its own.
StudyPlan plan_of(int repetitions, std::uint64_t seed) {
    StudyPlan plan = test::short_cable_plan(repetitions, seed);
    plan.fusion_methods = {"mean", "mean_r", "maximum_likelihood", "posterior_mean"};
    plan.noise_levels = {{"biased", {0.05, 0.0, 0.6}}};
    return plan;
}

struct Recommended {
    storage::StudyDescription study;
    std::vector<storage::RecommendationRecord> records;
};

class RecommendationCoverage : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        truth_plan = new StudyPlan(plan_of(40000, 987654321));
        truth = new test::EveryLayout(*truth_plan, 0, 0);
        truth->draws.extend({40000, 1000}, truth->weights, 0);
        answers = new std::vector<Recommended>(coverage_studies);
        parallel_for_each_index(coverage_studies, 0, [](int k) {
            test::TemporaryStudy file;
            RunOptions options;
            options.jobs = 1;
            const auto id = run_study(file.database(), plan_of(200, 1000 + k), "test", options).study_id;
            (*answers)[k] = {storage::load_study(file.database(), id),
                             storage::read_recommendations(file.database(), id)};
        });
    }
    static void TearDownTestSuite() {
        delete answers;
        delete truth;
        delete truth_plan;
    }

    static double true_error_N(const Recommended& answer, const storage::RecommendationRecord& record,
                               int set_index, const std::string& method) {
        std::vector<int> nodes = answer.study.sensor_sets[set_index].nodes;
        for (int& node : nodes) --node;
        const int candidate = truth->candidate(nodes, method);
        double error_N = 0.0;
        for (std::size_t s = 0; s < truth->study.scenarios.size(); ++s) {
            const double own_N = truth->draws.scenarios()[s].error_N[candidate];
            if (record.scope == "duty_cycle") error_N += 0.5 * own_N;
            if (name_of(truth->study.scenarios[s].regime) == record.regime) error_N += own_N;
        }
        return error_N;
    }
    /// Regrets have no fixed truth: what they are measured from is chosen by each study.
    template <class Visit>
    static void for_each_record(const Visit& visit) {
        for (const Recommended& answer : *answers) {
            for (const auto& record : answer.records) {
                if (record.scope != "minimax_regret") visit(answer, record);
            }
        }
    }

    static StudyPlan* truth_plan;
    static test::EveryLayout* truth;
    static std::vector<Recommended>* answers;
};
StudyPlan* RecommendationCoverage::truth_plan = nullptr;
test::EveryLayout* RecommendationCoverage::truth = nullptr;
std::vector<Recommended>* RecommendationCoverage::answers = nullptr;

// Of one question in 400 studies the share has a standard deviation of 1.1%, so three questions are put
// together for the narrow limits, and each alone may stray by two more deviations.
TEST_F(RecommendationCoverage, IntervalsOfRecommendationsCoverTheTruth93To97Percent) {
    std::map<std::string, Tally> tallies;
    Tally together;
    for_each_record([&](const Recommended& answer, const storage::RecommendationRecord& record) {
        const double error_N = true_error_N(answer, record, record.set_index, record.method);
        const bool covered = record.interval_low_N <= error_N && error_N <= record.interval_high_N;
        for (Tally* tally : {&together, &tallies[record.scope + " " + record.regime]}) {
            tally->covered += covered;
            ++tally->all;
        }
    });
    EXPECT_EQ(tallies.size(), 3u);  // two regimes and the duty cycle
    EXPECT_GE(together.fraction(), 0.93);
    EXPECT_LE(together.fraction(), 0.97);
    for (const auto& [question, tally] : tallies) {
        EXPECT_GE(tally.fraction(), 0.915) << question;
        EXPECT_LE(tally.fraction(), 0.985) << question;
        EXPECT_EQ(tally.all, coverage_studies);
    }
}

TEST_F(RecommendationCoverage, IntervalsOfTheBestAtEachCountCoverTheTruthAtLeast95Percent) {
    std::map<std::string, Tally> tallies;
    for_each_record([&](const Recommended& answer, const storage::RecommendationRecord& record) {
        for (const auto& count : record.counts) {
            const double error_N = true_error_N(answer, record, count.set_index, count.method);
            Tally& tally =
                tallies[record.scope + " " + record.regime + " " + std::to_string(count.sensor_count)];
            tally.covered += count.interval_low_N <= error_N && error_N <= count.interval_high_N;
            ++tally.all;
        }
    });
    for (const auto& [question, tally] : tallies) EXPECT_GE(tally.fraction(), 0.95) << question;
}

TEST_F(RecommendationCoverage, DrawsOfTheSearchAreOptimistic) {
    double optimism_N = 0.0;
    double truth_less_searched_N = 0.0;
    int all = 0;
    for_each_record([&](const Recommended& answer, const storage::RecommendationRecord& record) {
        optimism_N += record.error_N - searched_error_N(record);
        truth_less_searched_N +=
            true_error_N(answer, record, record.set_index, record.method) - searched_error_N(record);
        ++all;
    });
    EXPECT_GT(optimism_N / all, 0.0);
    // What is printed is what it is: both means are off by about 0.0005 N of chance.
    EXPECT_NEAR(optimism_N / all, truth_less_searched_N / all, 0.002);
}

}  // namespace
}  // namespace capstan
