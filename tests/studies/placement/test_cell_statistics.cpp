#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/intervals.h"
#include "capstan/placement/repetition_blocks.h"
#include "capstan/platform/parallel_for.h"

namespace capstan {
namespace {

double quantile_of(std::vector<double> values, double fraction) {
    return quantile(values, fraction);
}

// Type 7: the share runs from the smallest value at 0 to the largest at 1, linearly between their places.
TEST(Quantile, IsOfTypeSeven) {
    EXPECT_DOUBLE_EQ(quantile_of({40, 10, 30, 20}, 0.0), 10.0);
    EXPECT_DOUBLE_EQ(quantile_of({40, 10, 30, 20}, 0.25), 17.5);
    EXPECT_DOUBLE_EQ(quantile_of({40, 10, 30, 20}, 0.5), 25.0);
    EXPECT_DOUBLE_EQ(quantile_of({40, 10, 30, 20}, 0.9), 37.0);
    EXPECT_DOUBLE_EQ(quantile_of({40, 10, 30, 20}, 1.0), 40.0);
    EXPECT_DOUBLE_EQ(quantile_of({3, 1, 2}, 0.5), 2.0);
    EXPECT_DOUBLE_EQ(quantile_of({7}, 0.95), 7.0);
}

TEST(MeanAndError, FollowTheirDefinition) {
    const std::vector<double> values = {1, 2, 3, 6};  // variance 14 / 3
    EXPECT_DOUBLE_EQ(mean_and_error(values).mean, 3.0);
    EXPECT_DOUBLE_EQ(mean_and_error(values).standard_error, std::sqrt(14.0 / 3.0 / 4.0));
    EXPECT_EQ(mean_and_error(std::vector{5.0}).standard_error, 0.0) << "one value shows no spread";
}

TEST(RepetitionBlocks, ContainEveryRepetitionOnce) {
    for (int repetitions = 1; repetitions <= 500; ++repetitions) {
        const RepetitionBlocks blocks{repetitions};
        ASSERT_LE(blocks.count(), RepetitionBlocks::max_blocks);
        int next = 0;
        for (int b = 0; b < blocks.count(); ++b) {
            ASSERT_EQ(blocks.first(b), next) << repetitions << " repetitions";
            ASSERT_GT(blocks.size(b), 0) << repetitions << " repetitions";
            next = blocks.end(b);
        }
        ASSERT_EQ(next, repetitions);
    }
}

TEST(ParallelForEachIndex, CallsEachIndexOnceAndPassesExceptionsOn) {
    for (const int jobs : {0, 1, 3}) {
        std::vector<int> calls(1000, 0);
        parallel_for_each_index(1000, jobs, [&](int i) { ++calls[i]; });
        EXPECT_EQ(calls, std::vector<int>(1000, 1));
        EXPECT_THROW(parallel_for_each_index(100, jobs,
                                             [](int i) {
                                                 if (i == 57) throw std::runtime_error("57");
                                             }),
                     std::runtime_error);
    }
}

// A cell of two nodes whose errors are given, repetition by repetition.
storage::CellRecord summarised(const std::vector<std::array<double, 2>>& errors_N) {
    const RepetitionBlocks blocks{static_cast<int>(errors_N.size())};
    std::vector<BlockSums> sums(blocks.count(), {0, 0, 0, 0, {0, 0}, {0, 0}});
    std::vector<int> sizes;
    std::vector<double> repetition_error_N;
    for (int b = 0; b < blocks.count(); ++b) {
        sizes.push_back(blocks.size(b));
        for (int r = blocks.first(b); r < blocks.end(b); ++r) {
            const auto& e = errors_N[r];
            repetition_error_N.push_back((std::abs(e[0]) + std::abs(e[1])) / 2);
            sums[b].error_N += repetition_error_N.back();
            sums[b].squared_error_N2 += (e[0] * e[0] + e[1] * e[1]) / 2;
            for (int i = 0; i < 2; ++i) {
                sums[b].node_abs_error_N[i] += std::abs(e[i]);
                sums[b].node_signed_error_N[i] += e[i];
            }
            sums[b].unverified += r % 2;
        }
    }
    return summarise_cell({0, "mean", 1, sums, sizes, repetition_error_N});
}

TEST(SummariseCell, FollowsItsDefinitions) {
    const storage::CellRecord cell = summarised({{1, 3}, {-1, -5}, {0, 2}, {2, -2}});
    EXPECT_DOUBLE_EQ(cell.mean_abs_error_N, 2.0);  // of 2, 3, 1, 2
    EXPECT_DOUBLE_EQ(cell.standard_error_N, std::sqrt(2.0 / 3.0 / 4.0));
    EXPECT_DOUBLE_EQ(cell.rms_error_N, std::sqrt(48.0 / 8.0));
    EXPECT_DOUBLE_EQ(cell.bias_N, 0.0);
    EXPECT_EQ(cell.worst_node, 2);
    EXPECT_DOUBLE_EQ(cell.worst_node_error_N, 3.0);
    EXPECT_DOUBLE_EQ(cell.nodes[0].mean_abs_error_N, 1.0);
    EXPECT_DOUBLE_EQ(cell.nodes[0].bias_N, 0.5);
    EXPECT_DOUBLE_EQ(cell.nodes[1].bias_N, -0.5);
    EXPECT_DOUBLE_EQ(cell.error_q50_N, 2.0);
    EXPECT_DOUBLE_EQ(cell.unverified_fraction, 0.5);
    EXPECT_EQ(cell.block_mean_abs_error_N, (std::vector<double>{2, 3, 1, 2}));
}

TEST(SummariseCell, BlocksAverageToTheMean) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<std::array<double, 2>> errors_N(80);
    for (auto& e : errors_N) e = {normal(random), normal(random)};
    const storage::CellRecord cell = summarised(errors_N);
    double mean_N = 0.0;
    for (const double block_N : cell.block_mean_abs_error_N) mean_N += block_N / 40;
    EXPECT_NEAR(mean_N, cell.mean_abs_error_N, 1e-14);
}

// 2000 cells: a coverage of 95% shows as 95% +- 0.5%, so 4 standard errors are inside 93 to 97%.
TEST(SummariseCell, IntervalCoversTheTruthInNineteenOfTwentyCells) {
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    const double truth_N = 0.4 * std::sqrt(2.0 / std::numbers::pi);  // mean of |0.4 e|
    constexpr int cells = 2000;
    int held = 0;
    for (int cell = 0; cell < cells; ++cell) {
        std::vector<std::array<double, 2>> errors_N(100);
        for (auto& e : errors_N) e = {0.4 * normal(random), 0.4 * normal(random)};
        const storage::CellRecord record = summarised(errors_N);
        held += record.interval_low_N < truth_N && truth_N < record.interval_high_N;
    }
    EXPECT_GT(held, 0.93 * cells);
    EXPECT_LT(held, 0.97 * cells);
}

}  // namespace
}  // namespace capstan
