#include <gtest/gtest.h>

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/single_sensor.h"
#include "paper_experiment.h"

namespace capstan {
namespace {

using test::Instant;
using test::paper_instant;

std::vector<double> estimate_N(const SensorBranch& branch, double reading_N) {
    std::vector<double> tension_N;
    for (std::size_t node = 0; node < branch.slope.size(); ++node) {
        tension_N.push_back(branch.tension_N(static_cast<int>(node), reading_N));
    }
    return tension_N;
}

TEST(SingleSensorEstimator, AReadingWithoutNoiseGivesTheTruthInMassMotion) {
    for (const int sample : test::mass_samples) {
        const Instant instant = paper_instant(sample);
        ASSERT_EQ(instant.truth.last_motion.kind, MotionKind::mass);
        const SingleSensorEstimator estimator(instant.problem(), DistalSide::excluded);
        for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
            const double reading_N = instant.truth.tension_N[sensor];
            const auto choice = estimator.choose(sensor, reading_N);
            ASSERT_GE(choice.verifying_patterns, 1) << "sensor " << sensor << " at sample " << sample;
            const SensorBranch& branch = estimator.branches(sensor)[choice.branch];
            EXPECT_EQ(branch.directions, direction_bits(instant.truth.last_motion, 10));
            EXPECT_LT(test::mean_abs_error_N(estimate_N(branch, reading_N), instant.truth.tension_N), 1e-12);
        }
    }
}

TEST(SingleSensorEstimator, ReproducesItsOwnReading) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        const SingleSensorEstimator estimator(instant.problem(), DistalSide::admitted);
        for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
            for (const SensorBranch& branch : estimator.branches(sensor)) {
                if (!branch.verified) continue;
                EXPECT_NEAR(branch.slope[sensor], 1.0, 1e-14);
                EXPECT_NEAR(branch.intercept_N[sensor], 0.0, 1e-14);
            }
        }
    }
}

TEST(SingleSensorEstimator, FallsBackToThePreviousStateWhenNoPatternVerifies) {
    const Instant instant = paper_instant(142);
    const SingleSensorEstimator estimator(instant.problem(), DistalSide::excluded);
    for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
        const auto branches = estimator.branches(sensor);
        for (std::size_t k = 0; k + 1 < branches.size(); ++k) EXPECT_TRUE(branches[k].verified);
        EXPECT_FALSE(branches.back().verified);
        EXPECT_EQ(estimate_N(branches.back(), 1.0), instant.previous.tension_N);
        EXPECT_EQ(estimate_N(branches.back(), 50.0), instant.previous.tension_N);
    }
    // Backward, a distal reading well above the truth would need the blocked end to have gone forward.
    const auto choice = estimator.choose(10, 1.5 * instant.truth.tension_N[10]);
    EXPECT_EQ(choice.verifying_patterns, 0);
    EXPECT_EQ(choice.branch, static_cast<int>(estimator.branches(10).size()) - 1);
}

TEST(SingleSensorEstimator, TakesTheFirstBranchThatHoldsTheReadingAndCountsAll) {
    const Instant instant = paper_instant(112);
    const SingleSensorEstimator estimator(instant.problem(), DistalSide::admitted);
    for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
        const auto branches = estimator.branches(sensor);
        for (double reading_N = 0.05; reading_N < 30.0; reading_N += 0.1) {
            int first = static_cast<int>(branches.size()) - 1;
            int verifying = 0;
            for (int k = static_cast<int>(branches.size()) - 2; k >= 0; --k) {
                if (branches[k].low_N < reading_N && reading_N < branches[k].high_N) {
                    first = k;
                    ++verifying;
                }
            }
            const auto choice = estimator.choose(sensor, reading_N);
            ASSERT_EQ(choice.branch, first);
            ASSERT_EQ(choice.verifying_patterns, verifying);
        }
    }
}

TEST(SingleSensorEstimator, RefusesMoreSegmentsThanAWordHolds) {
    const QuasiStaticStep step(test::paper_cable(64), ModelRules::paper());
    const CableState rest = pretensioned(step.cable());
    const EstimationProblem problem{step, rest, rest.displacement_m.front() - 1e-4};
    EXPECT_THROW(SingleSensorEstimator(problem, DistalSide::excluded), InvalidInput);
}

TEST(SingleSensorEstimator, TakesAsManySegmentsAsAWordHolds) {
    const QuasiStaticStep step(test::paper_cable(63), ModelRules::paper());
    const CableState rest = pretensioned(step.cable());
    const EstimationProblem problem{step, rest, rest.displacement_m.front() - 1e-4};
    EXPECT_EQ(SingleSensorEstimator(problem, DistalSide::excluded).nodes(), 64);
}

TEST(SingleSensorEstimator, TriesPatternsTheOtherWayRoundWhereAskedTo) {
    const Instant instant = paper_instant(6);
    const SingleSensorEstimator near(instant.problem(), DistalSide::admitted);
    const SingleSensorEstimator far(instant.problem(), DistalSide::admitted, PatternOrder::farthest_first);
    for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
        const auto near_first = near.branches(sensor);
        const auto far_first = far.branches(sensor);
        ASSERT_EQ(near_first.size(), far_first.size());
        const std::size_t verified = near_first.size() - 1;  // the fallback stays the last
        for (std::size_t k = 0; k < verified; ++k)
            EXPECT_EQ(near_first[k].directions, far_first[verified - 1 - k].directions);
    }
}

// Segment 9 is the last one of the distal side; where all slide there is no side of its own.
TEST(SingleSensorEstimator, ExcludesExactlyThePatternsWithASideThatTheDistalEndMoves) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        const SingleSensorEstimator admitted(instant.problem(), DistalSide::admitted);
        const SingleSensorEstimator excluded(instant.problem(), DistalSide::excluded);
        for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
            std::vector<DirectionBits> expected;
            for (const SensorBranch& branch : admitted.branches(sensor)) {
                const std::uint64_t sliding = branch.directions.forward | branch.directions.backward;
                const bool of_distal_side = sliding >> 9 != 0 && sliding != (1u << 10) - 1;
                if (!branch.verified || !of_distal_side) expected.push_back(branch.directions);
            }
            const auto branches = excluded.branches(sensor);
            ASSERT_EQ(branches.size(), expected.size());
            for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(branches[k].directions, expected[k]);
        }
    }
}

struct SensorSpread {
    double mean_N = 0.0;
    double standard_error_N = 0.0;
    double unverified_fraction = 0.0;
};

SensorSpread errors_of(int sensor, int sample) {
    constexpr int repetitions = 2000;
    const Instant instant = paper_instant(sample);
    const SingleSensorEstimator estimator(instant.problem(), DistalSide::excluded);
    double sum_N = 0.0;
    double squares = 0.0;
    int unverified = 0;
    for (int r = 0; r < repetitions; ++r) {
        const double reading_N = test::noisy_readings(instant, sample, r)[sensor];
        const auto choice = estimator.choose(sensor, reading_N);
        const double error_N = test::mean_abs_error_N(
            estimate_N(estimator.branches(sensor)[choice.branch], reading_N), instant.truth.tension_N);
        sum_N += error_N;
        squares += error_N * error_N;
        unverified += choice.verifying_patterns == 0;
    }
    const double mean_N = sum_N / repetitions;
    return {mean_N, std::sqrt((squares / repetitions - mean_N * mean_N) / repetitions),
            static_cast<double>(unverified) / repetitions};
}

// Stored numbers, from an independent prototype with 2000 draws of its own: the difference of two such means
// spreads by sqrt(2) standard errors; 3 of those, and half a unit of the last digit given.
TEST(SingleSensorEstimator, HasTheErrorsOfThePapersPrototype) {
    const auto expect_mean = [](int sensor, double prototype_N) {
        const SensorSpread forward = errors_of(sensor, 112);
        const SensorSpread backward = errors_of(sensor, 142);
        const double mean_N = 0.5 * (forward.mean_N + backward.mean_N);
        const double error_N = 0.5 * std::hypot(forward.standard_error_N, backward.standard_error_N);
        EXPECT_NEAR(mean_N, prototype_N, 0.005 + 3.0 * std::sqrt(2.0) * error_N) << "node " << sensor + 1;
    };
    expect_mean(0, 1.36);
    expect_mean(10, 0.415);
}

// 0.49 of the prototype's draws; a fraction of 2000 draws spreads by 0.011, two of them by 0.016.
TEST(SingleSensorEstimator, HalfOfTheDistalReadingsVerifyNowhereWhileTheCableIsPulledBack) {
    EXPECT_NEAR(errors_of(10, 142).unverified_fraction, 0.49, 3.0 * 0.016);
}

}  // namespace
}  // namespace capstan
