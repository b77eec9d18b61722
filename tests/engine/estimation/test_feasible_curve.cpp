#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "fusion_bench.h"

namespace capstan {
namespace {

using test::Instant;
using test::paper_instant;

FeasibleCurve curve_of(const Instant& instant, int points) {
    return FeasibleCurve(instant.problem(), {test::distal_reach_m, points});
}

std::vector<double> state_N(const FeasibleCurve& curve, int point) {
    std::vector<double> tension_N;
    for (int node = 0; node < curve.nodes(); ++node) tension_N.push_back(curve.tension_N(node)[point]);
    return tension_N;
}

TEST(FeasibleCurve, CoversThePriorWithCellsOfEqualWidth) {
    const Instant instant = paper_instant(112);
    const FeasibleCurve curve = curve_of(instant, 128);
    const auto distal_m = curve.distal_displacement_m();
    const double cell_m = 2.0 * test::distal_reach_m / 128;
    EXPECT_NEAR(distal_m.front(), -test::distal_reach_m + cell_m / 2, 1e-16);
    EXPECT_NEAR(distal_m.back(), test::distal_reach_m - cell_m / 2, 1e-16);
    for (int k = 1; k < 128; ++k) EXPECT_NEAR(distal_m[k] - distal_m[k - 1], cell_m, 1e-16);
}

// E10: each point is the step under its distal displacement, and keeps the proximal one.
TEST(FeasibleCurve, EachPointSolvesTheStepForItsDistalDisplacement) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        const FeasibleCurve curve = curve_of(instant, 64);
        for (int k = 0; k < curve.points(); ++k) {
            CableState state = instant.previous;
            instant.step.advance(state, {EndCondition::position_m(instant.truth.displacement_m.front()),
                                         EndCondition::position_m(curve.distal_displacement_m()[k])});
            EXPECT_EQ(state_N(curve, k), state.tension_N);
            EXPECT_EQ(state.displacement_m.front(), instant.truth.displacement_m.front());
        }
    }
}

// How far the curve's nearest point to the truth is from it, at the worst node. The blocked end did not move,
// so that the truth is halfway between the two points in the middle.
double distance_from_truth_N(const Instant& instant, int points) {
    const FeasibleCurve curve = curve_of(instant, points);
    double nearest_N = 1e9;
    for (const int k : {points / 2 - 1, points / 2}) {
        double worst_N = 0.0;
        for (int i = 0; i < instant.nodes(); ++i) {
            worst_N = std::max(worst_N, std::abs(curve.tension_N(i)[k] - instant.truth.tension_N[i]));
        }
        nearest_N = std::min(nearest_N, worst_N);
    }
    return nearest_N;
}

TEST(FeasibleCurve, PassesThroughTheTruthUnderTheConsistentRules) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = test::instant_of(step, sample);
        const double coarse_N = distance_from_truth_N(instant, 64);
        const double fine_N = distance_from_truth_N(instant, 64 * 64);
        EXPECT_LT(fine_N, coarse_N / 32.0) << "sample " << sample;  // first order: 64 times nearer, or so
    }
}

// The paper's two elongation rules part by 0.2% at equal tensions, in each of up to ten segments, which opens
// gaps where a front passes: up to 2% of the tension at the worst node.
TEST(FeasibleCurve, PassesNearTheTruthUnderThePapersRules) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        EXPECT_LT(distance_from_truth_N(instant, 64 * 64), 0.02 * instant.mean_tension_N())
            << "sample " << sample;
    }
}

TEST(FeasibleCurve, RefusesAPriorThatItCannotSample) {
    const Instant instant = paper_instant(112);
    for (const DistalMotionPrior& prior :
         {DistalMotionPrior{0.0, 64}, DistalMotionPrior{-1e-3, 64}, DistalMotionPrior{std::nan(""), 64},
          DistalMotionPrior{1e-3, 0}, DistalMotionPrior{1e-3, 100}, DistalMotionPrior{1e-3, -8}}) {
        EXPECT_THROW(FeasibleCurve(instant.problem(), prior), InvalidInput)
            << prior.largest_increment_m << " m, " << prior.points << " points";
    }
}

// A saturated sensor means "at least this tension". The likelihood is 1 for tensions far above the range, one
// half at the range itself, and never falls with the tension.
TEST(CurveLikelihood, ASaturatedReadingIsALowerLimit) {
    const Instant instant = paper_instant(112);
    const FeasibleCurve curve = curve_of(instant, 128);
    const int node = 10;
    const auto along_N = curve.tension_N(node);
    const double range_N = along_N[64];
    const CurveLikelihood likelihood(curve, {.additive_N = 0.2, .range_N = range_N});
    std::vector<double> log_likelihood(128);
    likelihood.log_likelihood(node, range_N, log_likelihood);
    EXPECT_NEAR(std::exp(log_likelihood[64]), 0.5, 1e-12);
    for (int a = 0; a < 128; ++a) {
        for (int b = 0; b < 128; ++b) {
            if (along_N[a] >= along_N[b]) continue;
            EXPECT_LE(log_likelihood[a], log_likelihood[b]);
        }
    }
}

TEST(CurveLikelihood, AnotherSensorAddsItsLogLikelihood) {
    const Instant instant = paper_instant(6);
    const FeasibleCurve curve = curve_of(instant, 64);
    const CurveLikelihood likelihood(curve, {.multiplicative_ratio = 0.1});
    std::vector<double> all(static_cast<std::size_t>(curve.nodes()) * 64);
    for (int node = 0; node < curve.nodes(); ++node) {
        likelihood.log_likelihood(node, 9.0 + 0.1 * node, std::span<double>(all).subspan(node * 64, 64));
    }
    std::vector<double> pair(64);
    std::vector<double> triple(64);
    std::vector<double> grown(64);
    add_log_likelihoods(all, std::vector<int>{2, 5}, pair);
    add_log_likelihoods(all, std::vector<int>{2, 5, 9}, triple);
    add_log_likelihood(pair, std::span<const double>(all).subspan(9 * 64, 64), grown);
    EXPECT_EQ(grown, triple);
    EXPECT_EQ(likeliest_point(grown), std::max_element(grown.begin(), grown.end()) - grown.begin());
}

TEST(CurveLikelihood, TakesTheFirstOfEquallyLikelyPoints) {
    std::vector<double> flat(16, -1.0);
    EXPECT_EQ(likeliest_point(flat), 0);
    flat[9] = flat[13] = 2.0;
    EXPECT_EQ(likeliest_point(flat), 9);
}

}  // namespace
}  // namespace capstan
