// Scores of candidates and their paired differences.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "capstan/placement/candidate_scores.h"
#include "capstan/placement/intervals.h"
#include "capstan/placement/placement_questions.h"

namespace capstan {
namespace {

constexpr int scenarios = 3;
constexpr int blocks = 40;

std::vector<PlacementCandidate> random_candidates(int count, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::vector<PlacementCandidate> candidates;
    for (int c = 0; c < count; ++c) {
        PlacementCandidate candidate{c, 1 + c % 3, "mean", {}, {}};
        for (int s = 0; s < scenarios; ++s) {
            std::vector<double> block_N(blocks);
            for (double& b : block_N) b = 1.0 + 0.1 * c + 0.05 * normal(random);
            candidate.error_N.push_back(mean_and_error(block_N).mean);
            candidate.block_error_N.push_back(block_N);
        }
        candidates.push_back(candidate);
    }
    return candidates;
}

TEST(WeightedScores, AreLinearInTheFractions) {
    std::mt19937_64 random(1);
    const auto candidates = random_candidates(4, random);
    const auto first = weighted_scores(candidates, {1.0, 0.0, 0.0});
    const auto last = weighted_scores(candidates, {0.0, 0.0, 1.0});
    const auto mixed = weighted_scores(candidates, {0.3, 0.0, 0.7});
    for (int c = 0; c < 4; ++c) {
        EXPECT_DOUBLE_EQ(first[c].objective_N, candidates[c].error_N[0]);
        EXPECT_NEAR(mixed[c].objective_N, 0.3 * first[c].objective_N + 0.7 * last[c].objective_N, 1e-14);
        for (int b = 0; b < blocks; ++b) {
            EXPECT_NEAR(mixed[c].block_objective_N[b],
                        0.3 * first[c].block_objective_N[b] + 0.7 * last[c].block_objective_N[b], 1e-14);
        }
    }
}

// What a sensor's bias does: both scenarios are off together, so their mean is off as much as either.
TEST(WeightedScores, SpreadIncludesErrorsSharedByScenarios) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    PlacementCandidate candidate{0, 1, "mean", {1.0, 1.0}, {std::vector<double>(blocks), {}}};
    for (double& b : candidate.block_error_N[0]) b = 1.0 + 0.05 * normal(random);
    candidate.block_error_N[1] = candidate.block_error_N[0];
    const auto scores = weighted_scores({candidate}, {0.5, 0.5});
    EXPECT_NEAR(mean_and_error(scores[0].block_objective_N).standard_error,
                mean_and_error(candidate.block_error_N[0]).standard_error, 1e-14);
}

std::vector<Score> regrets_from_the_best(const std::vector<PlacementCandidate>& candidates,
                                         const std::vector<std::vector<double>>& fractions) {
    return regret_scores(candidates, fractions, best_of_regimes(candidates, fractions));
}

TEST(RegretScores, BestCandidateOfTheOnlyRegimeHasNoRegret) {
    std::mt19937_64 random(2);
    const auto candidates = random_candidates(5, random);
    const auto regrets = regrets_from_the_best(candidates, {{0.5, 0.5, 0.0}});
    EXPECT_EQ(regrets[0].objective_N, 0.0);
    EXPECT_EQ(mean_and_error(regrets[0].block_objective_N).standard_error, 0.0);
    for (int c = 1; c < 5; ++c) EXPECT_GT(regrets[c].objective_N, 0.0);
}

TEST(RegretScores, AreTheWorstOverRegimesAndNeverNegative) {
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const auto candidates = random_candidates(6, random);
        const std::vector<std::vector<double>> fractions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        const auto all = regrets_from_the_best(candidates, fractions);
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            double worst_N = 0.0;
            for (const auto& fraction : fractions) {
                worst_N = std::max(worst_N, regrets_from_the_best(candidates, {fraction})[c].objective_N);
            }
            EXPECT_DOUBLE_EQ(all[c].objective_N, worst_N);
            EXPECT_GE(all[c].objective_N, 0.0);
        }
    }
}

TEST(PlacementCandidates, ExcludeMethodsThatNeedTheTrueDirection) {
    storage::StudyDescription study;
    study.fusion_methods = {{"mean_known", "", "direction_known", ""}, {"mean", "", "direction_unknown", ""}};
    study.sensor_sets = {{{1, 6, 11}}};
    const auto candidates = placement_candidates(study, {{0, 0, "mean_known", 0.1, 0.01, {0.1}},
                                                         {0, 0, "mean", 0.5, 0.02, {0.5}},
                                                         {1, 0, "mean", 0.7, 0.03, {0.7}}});
    ASSERT_EQ(candidates.size(), 1u);
    EXPECT_EQ(candidates[0].method, "mean");
    EXPECT_EQ(candidates[0].sensor_count, 3);
    EXPECT_EQ(candidates[0].error_N, (std::vector<double>{0.5, 0.7}));
}

Score score_of(const std::vector<double>& block_N) {
    return {mean_and_error(block_N).mean, block_N};
}

TEST(SimultaneousDifferences, OfIdenticalCandidatesAreZero) {
    const Score score = score_of({1.0, 1.5, 0.5, 2.0});
    const auto differences = simultaneous_differences({score, score}, 0, {1});
    ASSERT_EQ(differences.size(), 1u);
    EXPECT_EQ(differences[0].difference.value_N, 0.0);
    EXPECT_EQ(differences[0].difference.low_N, 0.0);
    EXPECT_EQ(differences[0].difference.high_N, 0.0);
}

// Two differences of mean 2 and standard error 1: Student's t with one degree of freedom is 12.706 for one
// interval, 25.452 for two together.
TEST(SimultaneousDifferences, AreStudentsIntervalsWithBonferronisCorrection) {
    const std::vector<Score> scores = {score_of({0, 0}), score_of({1, 3}), score_of({3, 1})};
    const auto alone = simultaneous_differences(scores, 0, {1});
    EXPECT_NEAR(alone[0].difference.low_N, 2.0 - 12.706, 0.001);
    EXPECT_NEAR(alone[0].difference.high_N, 2.0 + 12.706, 0.001);
    const auto together = simultaneous_differences(scores, 0, {1, 2});
    EXPECT_NEAR(together[0].difference.high_N, 2.0 + 25.452, 0.001);
    EXPECT_EQ(together[1].candidate, 2);
}

TEST(SimultaneousDifferences, AreUnboundedWithoutASecondBlock) {
    const auto differences = simultaneous_differences({score_of({1.0}), score_of({2.0})}, 0, {1});
    EXPECT_LE(differences[0].difference.low_N, 1.0);
    EXPECT_TRUE(std::isinf(differences[0].difference.high_N)) << "one block shows no spread";
}

// 500 trials of eight candidates that share part of their noise: 95% show as 95% +- 1%; two of those allowed.
TEST(SimultaneousDifferences, HoldTogetherInAtLeast95PercentOfStudies) {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    constexpr int trials = 500;
    constexpr int candidates = 8;
    int all_held = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<std::vector<double>> block_N(candidates, std::vector<double>(blocks));
        for (int b = 0; b < blocks; ++b) {
            const double shared_N = normal(random);
            for (int c = 0; c < candidates; ++c) block_N[c][b] = 0.01 * c + 0.1 * (shared_N + normal(random));
        }
        std::vector<Score> scores;
        for (const auto& candidate : block_N) scores.push_back(score_of(candidate));
        bool held = true;
        for (const auto& d : simultaneous_differences(scores, 2, {0, 1, 3, 4, 5, 6, 7})) {
            const double truth_N = 0.01 * (d.candidate - 2);
            held = held && d.difference.low_N <= truth_N && truth_N <= d.difference.high_N;
        }
        all_held += held;
    }
    EXPECT_GE(all_held, (0.95 - 2 * 0.01) * trials);
}

int count_where(const std::vector<CountError>& by_count) {
    return count_where_gain_flattens(by_count, 0.02);
}

TEST(CountWhereGainFlattens, MeasuresTheGainOfEachSensorWhereSeveralAreAdded) {
    EXPECT_EQ(count_where({{1, 1.0}, {4, 0.95}}), 1) << "0.017 N for each of three";
    EXPECT_EQ(count_where({{1, 1.0}, {4, 0.93}}), 4) << "0.023 N for each of three";
    EXPECT_EQ(count_where({{2, 1.0}, {3, 0.97}, {11, 0.82}}), 3) << "0.019 N for each of eight";
}

TEST(CountWhereGainFlattens, LooksBeyondACountThatGainsLittle) {
    EXPECT_EQ(count_where({{1, 1.0}, {2, 0.99}, {3, 0.93}}), 3) << "0.035 N for each of two";
    EXPECT_EQ(count_where({{1, 1.0}, {2, 0.99}, {3, 0.97}}), 1) << "0.015 N for each of two";
}

TEST(CountWhereGainFlattens, IsTheOnlyCountOrNone) {
    EXPECT_EQ(count_where({{5, 1.0}}), 5);
    EXPECT_EQ(count_where({}), 0);
}

}  // namespace
}  // namespace capstan
