// What a reading does to one row of an ensemble (E58).
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "capstan/ensemble/ensemble_rows.h"

namespace capstan {
namespace {

struct SensedRow {
    std::vector<double> row, sensed, moves;

    // Standard normal, with this correlation exactly.
    SensedRow(std::size_t members, double correlation, unsigned seed)
        : row(members), sensed(members), moves(members, 1.0) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        for (double& each : sensed) each = normal(random);
        centre(sensed);
        for (double& each : row) each = normal(random);
        centre(row);
        const double along = dot(row, sensed) / dot(sensed, sensed);
        for (std::size_t j = 0; j < members; ++j) row[j] -= along * sensed[j];
        const double scale = std::sqrt(dot(sensed, sensed) / dot(row, row));
        for (std::size_t j = 0; j < members; ++j)
            row[j] = correlation * sensed[j] + std::sqrt(1.0 - correlation * correlation) * scale * row[j];
    }

    void correct(double off, double noise_variance) {
        const double squares = dot(sensed, sensed);
        const double noise = noise_variance * (static_cast<double>(row.size()) - 1.0);
        const ExpectedFraction expected(static_cast<int>(row.size()), 1.0);
        double* rows[] = {row.data()};
        correct_rows({sensed, moves, off, squares, squares + noise, expected}, rows);
    }

    static double dot(const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t j = 0; j < a.size(); ++j) sum += a[j] * b[j];
        return sum;
    }
    static void centre(std::vector<double>& of) {
        double mean = 0.0;
        for (const double each : of) mean += each / static_cast<double>(of.size());
        for (double& each : of) each -= mean;
    }
};

// Kalman: x = r h, h normal with variance v, read with noise of variance R.
TEST(EnsembleRows, ACertainCorrelationGivesTheKalmanMeanAndVariance) {
    SensedRow sensed(64, 1.0, 1);
    const double variance = std::pow(moments_of_row(sensed.row).deviation, 2);
    sensed.correct(0.7, 0.5);
    const RowMoments after = moments_of_row(sensed.row);
    EXPECT_NEAR(after.mean, 0.7 * variance / (variance + 0.5), 1e-6);
    EXPECT_NEAR(after.deviation * after.deviation, variance * 0.5 / (variance + 0.5), 1e-6);
}

// The mean moves by s of the Kalman gain; the variance falls by s^2 of what the correlation would explain.
TEST(EnsembleRows, TheSpreadFallsByWhatTheExpectedCorrelationExplains) {
    for (const double correlation : {0.2, 0.35, 0.6}) {
        SensedRow sensed(64, correlation, 2);
        const double deviation = moments_of_row(sensed.sensed).deviation;
        const double before = std::pow(moments_of_row(sensed.row).deviation, 2);
        const double expected = ExpectedFraction(64, 1.0).of_squared(correlation * correlation);
        sensed.correct(0.7, 0.5);
        const RowMoments after = moments_of_row(sensed.row);
        const double total = deviation * deviation + 0.5;
        const double covariance = correlation * deviation * std::sqrt(before);
        EXPECT_NEAR(after.mean, expected * covariance / total * 0.7, 1e-9);
        EXPECT_NEAR(before - after.deviation * after.deviation,
                    expected * expected * covariance * covariance / total, 1e-9);
    }
}

TEST(EnsembleRows, CorrelationsByChanceAreMostlyLeftOutAndClearOnesKept) {
    EXPECT_LT(expected_fraction(1.0 / 8.0, 64.0, 1.0), 0.1);
    EXPECT_GT(expected_fraction(0.5, 64.0, 1.0), 0.9);
    EXPECT_NEAR(expected_fraction(1.0, 64.0, 1.0), 1.0, 1e-6);
    EXPECT_GT(expected_fraction(1.0 / 8.0, 1024.0, 1.0), 0.9);  // with many members it is not chance
    for (double r = 0.02; r < 0.97; r += 0.05) {
        EXPECT_LT(expected_fraction(r, 64.0, 1.0), expected_fraction(r + 0.05, 64.0, 1.0)) << r;
        // What is clear of chance is less so where chance is larger.
        if (r > 0.2) {
            EXPECT_LT(expected_fraction(r, 64.0, 2.0), expected_fraction(r, 64.0, 1.0)) << r;
        }
    }
}

// From the fewest to the most members of a configuration.
TEST(EnsembleRows, TheTableOfExpectedFractionsIsWithinItsError) {
    for (const int members : {16, 64, 128, 264, 1024})
        for (const double chance : {1.0, 2.0}) {
            const ExpectedFraction table(members, chance);
            for (double r = 0.0; r < 1.0; r += 1.3e-5)
                ASSERT_NEAR(table.of_squared(r * r), expected_fraction(r, members, chance), 1e-4)
                    << members << " members, chance " << chance << ", r " << r;
            EXPECT_NEAR(table.of_squared(1.0 + 1e-12), 1.0, 1e-6);
            EXPECT_NEAR(table.of_squared(std::nan("")), 1.0, 1e-6);
        }
}

TEST(EnsembleRows, AMemberThatIsLeftAloneKeepsItsValue) {
    SensedRow sensed(64, 0.8, 3);
    sensed.moves[5] = 0.0;
    const double before = sensed.row[5];
    const double other = sensed.row[6];
    sensed.correct(0.7, 0.5);
    EXPECT_EQ(sensed.row[5], before);
    EXPECT_NE(sensed.row[6], other);
}

}  // namespace
}  // namespace capstan
