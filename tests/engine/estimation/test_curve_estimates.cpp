// What is read off the feasible curve: likelihoods, their maximum, the posterior mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/estimation/curve_peak.h"
#include "fusion_bench.h"

namespace capstan {
namespace {

using test::FusionBench;
using test::Instant;
using test::paper_instant;

// exp, sums and the quotient again, one point after the other in long double.
TEST(PosteriorMean, IsThatOfAScalarReferenceInLongDouble) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        for (const int points : {8, 24, 128, 1024}) {
            const FusionBench bench(instant, test::noisy_readings(instant, sample, points), test::ten_percent,
                                    points);
            const auto log_likelihood = bench.log_likelihood_of({0, 5, 9, 10});
            const long double top = *std::max_element(log_likelihood.begin(), log_likelihood.end());
            const auto tension_N = bench.fuse(posterior_mean_method, {0, 5, 9, 10});
            for (int i = 0; i < instant.nodes(); ++i) {
                long double total = 0.0L;
                long double sum_N = 0.0L;
                for (int k = 0; k < points; ++k) {
                    const long double weight = std::exp(static_cast<long double>(log_likelihood[k]) - top);
                    total += weight;
                    sum_N += weight * bench.curve().tension_N(i)[k];
                }
                const double reference_N = static_cast<double>(sum_N / total);
                EXPECT_NEAR(tension_N[i], reference_N, 1e-12 * std::abs(reference_N)) << points << " points";
            }
        }
    }
}

TEST(PosteriorMean, ConvergesAsTheGridGetsFiner) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        double coarse_N = 0.0;
        double medium_N = 0.0;
        for (int r = 0; r < 50; ++r) {
            const auto reading_N = test::noisy_readings(instant, sample, r);
            const auto mean_N = [&](int points) {
                return FusionBench(instant, reading_N, test::ten_percent, points)
                    .fuse(posterior_mean_method, {8, 9, 10});
            };
            const auto fine_N = mean_N(1024);
            coarse_N += test::mean_abs_error_N(mean_N(64), fine_N) / 50;
            medium_N += test::mean_abs_error_N(mean_N(128), fine_N) / 50;
        }
        EXPECT_LT(medium_N, 0.75 * coarse_N) << "sample " << sample;
        EXPECT_LT(medium_N, 0.01) << "a study's 128 points are as good as any";
    }
}

TEST(MaximumLikelihood, StaysBesideTheMostLikelyPointOfTheGrid) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        for (int r = 0; r < 100; ++r) {
            const FusionBench bench(instant, test::noisy_readings(instant, sample, r), test::ten_percent);
            const auto log_likelihood = bench.log_likelihood_of({8, 9, 10});
            const int best = static_cast<int>(std::max_element(log_likelihood.begin(), log_likelihood.end()) -
                                              log_likelihood.begin());
            const auto tension_N = bench.fuse(maximum_likelihood_method, {8, 9, 10});
            for (int i = 0; i < instant.nodes(); ++i) {
                const auto along = bench.curve().tension_N(i);
                const double low_N =
                    std::min({along[std::max(best - 1, 0)], along[best], along[std::min(best + 1, 127)]});
                const double high_N =
                    std::max({along[std::max(best - 1, 0)], along[best], along[std::min(best + 1, 127)]});
                ASSERT_GE(tension_N[i], low_N - 1e-12);
                ASSERT_LE(tension_N[i], high_N + 1e-12);
            }
        }
    }
}

double log_likelihood_at(const std::vector<double>& tension_N, const std::vector<double>& reading_N,
                         const std::vector<int>& sensors) {
    double sum = 0.0;
    for (const int sensor : sensors) {
        const double deviation_N = reading_deviation_N(test::ten_percent, tension_N[sensor]);
        sum -=
            0.5 * std::pow((reading_N[sensor] - tension_N[sensor]) / deviation_N, 2) + std::log(deviation_N);
    }
    return sum;
}

// Where the curve has a kink a parabola overshoots a little: by less than 0.2 of log likelihood, which no one
// would call evidence, and on average it gains.
TEST(MaximumLikelihood, IsAsLikelyAsTheBestPointOfTheGridOrMore) {
    double gain = 0.0;
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        for (const std::vector<int>& sensors : {std::vector{10}, {0}, {8, 9, 10}, {0, 5, 10}}) {
            for (int r = 0; r < 200; ++r) {
                const auto reading_N = test::noisy_readings(instant, sample, r);
                const FusionBench bench(instant, reading_N, test::ten_percent);
                const auto log_likelihood = bench.log_likelihood_of(sensors);
                const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
                const auto tension_N = bench.fuse(maximum_likelihood_method, sensors);
                const double ours = log_likelihood_at(tension_N, reading_N, sensors);
                gain += ours - best;
                EXPECT_GE(ours, best - 0.2)
                    << "sample " << sample << ", repetition " << r << ", " << sensors.size() << " sensors";
            }
        }
    }
    EXPECT_GT(gain, 0.0);
}

TEST(CurveLikelihood, IsTheNormalDensityOfTheReading) {
    const Instant instant = paper_instant(112);
    const FeasibleCurve curve(instant.problem(), {test::distal_reach_m, 64});
    const CurveLikelihood likelihood(curve, test::ten_percent);
    std::vector<double> result(64);
    for (const int sensor : {0, 4, 10}) {
        likelihood.log_likelihood(sensor, 7.5, result);
        for (int k = 0; k < 64; ++k) {
            std::vector<double> reading_N(instant.nodes(), 7.5);
            std::vector<double> tension_N;
            for (int node = 0; node < curve.nodes(); ++node) tension_N.push_back(curve.tension_N(node)[k]);
            EXPECT_NEAR(result[k], log_likelihood_at(tension_N, reading_N, {sensor}), 1e-10);
        }
    }
}

// A reading at the end of the range stands for every noisy tension from there on.
TEST(CurveLikelihood, ASaturatedReadingIsAsLikelyAsAllReadingsBeyondTheRangeTogether) {
    const Instant instant = paper_instant(112);
    const FeasibleCurve curve(instant.problem(), {test::distal_reach_m, 64});
    const double range_N = instant.truth.tension_N[10];
    const CurveLikelihood unlimited(curve, {.additive_N = 0.5});
    const CurveLikelihood limited(curve, {.additive_N = 0.5, .range_N = range_N});
    std::vector<double> expected(64, 0.0);
    std::vector<double> result(64);
    constexpr double step_N = 0.01;
    for (double reading_N = range_N + 0.5 * step_N; reading_N < range_N + 30.0; reading_N += step_N) {
        unlimited.log_likelihood(10, reading_N, result);
        for (int k = 0; k < 64; ++k)
            expected[k] += step_N * std::exp(result[k]) / std::sqrt(2.0 * std::numbers::pi);
    }
    limited.log_likelihood(10, range_N, result);
    for (int k = 0; k < 64; ++k) EXPECT_NEAR(std::exp(result[k]), expected[k], 1e-4);
}

TEST(CurveLikelihood, OfAllSensorsStartsFromNothing) {
    const std::vector<double> per_sensor = {1.0, 2.0, 30.0, 40.0, 500.0, 600.0};  // sensors x points
    std::vector<double> result = {7.0, 7.0};
    add_log_likelihoods(per_sensor, std::vector{0, 2}, result);
    EXPECT_EQ(result, (std::vector{501.0, 602.0}));
}

TEST(MaximumLikelihood, IsTheTopOfAParabolaWhereverItIsBetweenTheEnds) {
    constexpr int points = 8;
    for (double top = 0.55; top < points - 1.5; top += 0.1) {
        std::vector<double> log_likelihood;
        for (int k = 0; k < points; ++k) log_likelihood.push_back(3.0 - 0.7 * (k - top) * (k - top));
        const CurvePlace place = likeliest_place(log_likelihood, static_cast<int>(std::round(top)));
        EXPECT_NEAR(place.point + place.fraction * (place.neighbour - place.point), top, 1e-12);
    }
}

// Pushed in by 3 cm the cable carries nothing, and multiplicative noise has no width there.
TEST(CurveLikelihood, IsFiniteWhereTheCableIsSlack) {
    const Instant start = paper_instant(1);
    const CableState rest = pretensioned(start.step.cable());
    const EstimationProblem problem{start.step, rest, rest.displacement_m.front() + 0.03};
    const FeasibleCurve curve(problem, {0.025, 64});
    ASSERT_EQ(curve.tension_N(5).front(), 0.0) << "the first points are slack";
    ASSERT_GT(curve.tension_N(5).back(), 0.0) << "the last ones are not";
    for (const NoiseLevel& noise : {test::ten_percent, NoiseLevel{}}) {
        const CurveLikelihood likelihood(curve, noise);
        std::vector<double> result(64);
        for (const double reading_N : {0.0, 1e-3, 5.0, 40.0}) {
            likelihood.log_likelihood(5, reading_N, result);
            for (const double value : result) ASSERT_TRUE(std::isfinite(value)) << reading_N << " N";
            std::vector<double> tension_N(curve.nodes());
            posterior_mean(curve, result, tension_N);
            for (const double node_N : tension_N) ASSERT_TRUE(std::isfinite(node_N)) << reading_N << " N";
        }
    }
}

// The peak is found while two rows are added; equal tops count at their first place.
TEST(CurvePeak, FoundWhileAddingIsTheFirstLargestOfTheSum) {
    for (const int points : {8, 16, 24}) {
        for (int pair = 0; pair < points * points; ++pair) {
            const int top = std::min(pair % points, pair / points);
            const auto again = static_cast<std::size_t>(std::max(pair % points, pair / points));
            std::vector<double> before(static_cast<std::size_t>(points));
            std::vector<double> sensor(before.size());
            std::vector<double> sum(before.size());
            for (int k = 0; k < points; ++k) {
                before[static_cast<std::size_t>(k)] = -std::abs(std::sin(3.0 * k)) - 0.1;
                sensor[static_cast<std::size_t>(k)] = -0.01 * k;
            }
            before[static_cast<std::size_t>(top)] = 1.0;
            sensor[static_cast<std::size_t>(top)] = 0.0;
            before[again] = 1.0;
            sensor[again] = 0.0;
            EXPECT_EQ(add_log_likelihood_and_find_peak(before, sensor, sum), top) << points;
            for (std::size_t k = 0; k < sum.size(); ++k) ASSERT_EQ(sum[k], before[k] + sensor[k]);
            EXPECT_EQ(likeliest_point(sum), top) << points;
        }
    }
}

TEST(CurvePeak, OnAPlateauIsThePointItself) {
    const std::vector<double> flat{0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0};
    EXPECT_EQ(likeliest_place(flat, 2).fraction, 0.0);
    EXPECT_EQ(likeliest_place(flat, 2).point, 2);
}

TEST(CurvePeak, IsTheFirstPointIfNoValueIsANumber) {
    const std::vector<double> none(16, std::nan(""));
    EXPECT_EQ(likeliest_point(none), 0);
    std::vector<double> sum(none.size());
    EXPECT_EQ(add_log_likelihood_and_find_peak(none, none, sum), 0);
}

}  // namespace
}  // namespace capstan
