#include <gtest/gtest.h>

#include <cmath>

#include "capstan/gap/bench_knowledge.h"

namespace capstan::gap {
namespace {

// A bench of which three numbers are stated, and known to a fifth if they were not measured.
BenchKnowledge stated_bench() {
    BenchKnowledge bench = measured_bench();
    for (FloatingNumber& number : bench.numbers) {
        number.prior_std = 0.2;
        number.measured_std = nominal_log_std;
    }
    return bench;
}

Eigen::Matrix3d independent(const Eigen::Vector3d& deviations) {
    return deviations.cwiseAbs2().asDiagonal();
}

TEST(StatedNumbers, AreWrongOnlyAsProbablyAsTheRecordingTells) {
    const BenchKnowledge bench = stated_bench();
    const auto friction_is_wrong = [&](double coordinate, double deviation) {
        return weigh_stated_numbers(bench, {coordinate, 0.0, 0.0}, independent({deviation, 0.2, 0.2}))
            .wrong[0];
    };
    EXPECT_GT(friction_is_wrong(0.1, 0.005), 0.99);  // told precisely, a tenth off
    EXPECT_LT(friction_is_wrong(0.01, 0.005), 0.1);  // within what a measurement may be off by
    EXPECT_LT(friction_is_wrong(0.05, 0.07), 0.2);   // as stated, for all that is told
    EXPECT_GT(friction_is_wrong(0.2, 0.05), friction_is_wrong(0.1, 0.05));
    const StatedNumbers untold =
        weigh_stated_numbers(bench, Eigen::Vector3d::Zero(), independent({0.2, 0.2, 0.2}));
    EXPECT_NEAR(untold.wrong[0], 0.26, 1e-6);  // half of 0.02 and half of 0.5
    EXPECT_NEAR(untold.log_gain, 0.0, 1e-6);
}

TEST(StatedNumbers, OneThatIsWrongAmongRightOnesIsWrongAlone) {
    const BenchKnowledge bench = stated_bench();
    const auto one_alone = [&](const Eigen::Vector3d& coordinates) {
        return weigh_stated_numbers(bench, coordinates, independent({0.005, 0.005, 0.005})).one_alone;
    };
    EXPECT_GT(one_alone({0.0, 0.0, 0.15}), 0.8);
    EXPECT_LT(one_alone({0.15, 0.0, 0.15}), 0.01);  // a bench of tables
    EXPECT_LT(one_alone({0.0, 0.0, 0.0}), 0.1);
}

TEST(StatedNumbers, AreJudgedTogether) {
    const BenchKnowledge bench = stated_bench();
    const auto pretension_is_wrong = [&](double others) {
        return weigh_stated_numbers(bench, {others, others, 0.05}, independent({0.005, 0.005, 0.07}))
            .wrong[2];
    };
    EXPECT_LT(pretension_is_wrong(0.0), 0.1);   // on a bench that was evidently measured
    EXPECT_GT(pretension_is_wrong(0.15), 0.3);  // on one that was not
}

// Of independent numbers the density of what is shown is a product of normal densities.
TEST(StatedNumbers, HaveTheEvidenceOfIndependentNormalDensities) {
    const BenchKnowledge bench = stated_bench();
    const Eigen::Vector3d coordinates(0.03, -0.01, 0.12);
    const Eigen::Vector3d deviations(0.02, 0.05, 0.04);
    double measured = 1.0;
    double any = 1.0;
    double prior = 1.0;
    for (Eigen::Index k = 0; k < 3; ++k) {
        const double wide = 0.2 * 0.2;
        const double told = 1.0 / (1.0 / std::pow(deviations[k], 2) - 1.0 / wide);
        const double shown = coordinates[k] * (told + wide) / wide;
        const auto density = [&](double variance) {
            return std::exp(-0.5 * shown * shown / (told + variance)) / std::sqrt(told + variance);
        };
        const double right = density(nominal_log_std * nominal_log_std);
        measured *= 0.98 * right + 0.02 * density(wide);
        any *= 0.5 * right + 0.5 * density(wide);
        prior *= density(wide);
    }
    EXPECT_NEAR(weigh_stated_numbers(bench, coordinates, independent(deviations)).log_gain,
                std::log(0.5 * (measured + any) / prior), 1e-9);
}

// Friction and pretension make the same loop: where only their sum is told, it is as stated or not.
TEST(StatedNumbers, ThatCompensateOneAnotherAreAsStatedTogether) {
    const BenchKnowledge bench = stated_bench();
    Eigen::Matrix3d covariance = independent({0.14, 0.01, 0.14});
    covariance(0, 2) = covariance(2, 0) = -0.139 * 0.14;
    const auto wrong = [&](double friction, double pretension) {
        return weigh_stated_numbers(bench, {friction, 0.0, pretension}, covariance).wrong;
    };
    EXPECT_LT(wrong(0.1, -0.1)[0], 0.1);  // as little as (0, 0)
    EXPECT_GT(wrong(0.1, 0.1)[0] + wrong(0.1, 0.1)[2], 0.9);
}

TEST(StatedNumbers, ThatWereStatedAsRangesAreNotWrong) {
    const BenchKnowledge bench = measured_bench({0.3, 0.3, 0.3});
    EXPECT_NEAR(weigh_stated_numbers(bench, {0.1, 0.2, 0.3}, independent({0.05, 0.05, 0.05})).log_gain, 0.0,
                1e-9);
}

}  // namespace
}  // namespace capstan::gap
