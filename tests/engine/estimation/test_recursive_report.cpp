// What a step of the recursive estimator reports, how its ends wander, and that a correction leaves a state
// whose displacements belong to its tensions, so that the next step goes on from there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/recursive_estimator.h"
#include "example_cables.h"

namespace capstan {
namespace {

const QuasiStaticStep& consistent_model() {
    static const QuasiStaticStep model(test::paper_cable(10), ModelRules::consistent());
    return model;
}

KnownEnds ends_of(const CableState& state) {
    return {state.displacement_m.front(), state.displacement_m.back()};
}

// The twin that does not read shows what was known of the tension before.
TEST(RecursiveReport, LogEvidenceIsThatOfANormalReadingOfWhatWasKnownBefore) {
    const CableState start = pretensioned(consistent_model().cable());
    for (const double wander_m : {0.0, 2e-3}) {
        for (const double value_N : {6.0, 10.0, 13.0}) {
            RecursiveSettings settings;
            settings.wander.distal_m = wander_m;
            RecursiveEstimator blind(consistent_model(), start, settings);
            RecursiveEstimator reading(consistent_model(), start, settings);
            const SensorSpot spot{7, 0.25};
            KnownEnds ends = ends_of(start);
            ends.proximal_displacement_m += 2e-3;
            const RecursiveReport nothing_read = blind.step(ends, {});
            EXPECT_EQ(nothing_read.log_evidence, 0.0);
            const TensionReading sensor{spot, value_N, {.additive_N = 0.8}};
            const double evidence = reading.step(ends, std::span(&sensor, 1)).log_evidence;
            const auto known = blind.at(spot);
            const double variance = known.deviation_N * known.deviation_N + 0.8 * 0.8;
            const double off_N = value_N - known.mean_N;
            EXPECT_NEAR(evidence, -0.5 * (off_N * off_N / variance + std::log(variance)), 1e-9);
        }
    }
}

TEST(RecursiveReport, CountsNoMemberOfATautCableAndAllOfASlackOne) {
    const CableState start = pretensioned(consistent_model().cable());
    RecursiveSettings settings;
    settings.members = 16;
    settings.wander.distal_m = 1e-5;
    RecursiveEstimator estimator(consistent_model(), start, settings);
    KnownEnds ends = ends_of(start);
    const RecursiveReport taut = estimator.step(ends, {});
    EXPECT_EQ(taut.slack, 0);
    EXPECT_EQ(taut.unverified, 0);
    ends.proximal_displacement_m += 0.05;  // pushed in
    const RecursiveReport slack = estimator.step(ends, {});
    EXPECT_EQ(slack.slack, 16);
    EXPECT_EQ(slack.unverified, 0);
}

// Friction that depends on speed takes two trials of a step; a member counts once.
TEST(RecursiveReport, WithDragASlackCableIsCountedOnceAndComesBackTaut) {
    const CableState start = pretensioned(consistent_model().cable());
    RecursiveSettings settings;
    settings.members = 8;
    settings.wander.distal_m = 1e-6;
    settings.rate_friction.viscous.drag_N_s_per_m2 = 3.0;
    settings.interval_s = 0.01;
    RecursiveEstimator estimator(consistent_model(), start, settings);
    int all_slack = 0;
    for (int step = 1; step <= 80; ++step) {
        KnownEnds ends = ends_of(start);
        ends.proximal_displacement_m += 0.02 * std::sin(2.0 * std::numbers::pi * step / 40.0);
        const RecursiveReport report = estimator.step(ends, {});
        EXPECT_LE(report.slack, 8);
        if (report.slack == 8) ++all_slack;
        for (const double mean_N : estimator.mean_N()) ASSERT_TRUE(std::isfinite(mean_N));
        if (report.slack == 0) {
            EXPECT_GT(estimator.mean_N()[5], 0.0);
        }
    }
    EXPECT_GT(all_slack, 3);
    EXPECT_LT(all_slack, 60);
}

// A slack cable slides at no speed that could be told; what drags on it when it is taut again does not depend
// on that.
TEST(RecursiveReport, TheDragIsBackAfterACableWasSlack) {
    const CableState start = pretensioned(consistent_model().cable());
    RecursiveSettings settings;
    settings.members = 8;
    settings.interval_s = 0.01;
    settings.rate_friction.viscous.drag_N_s_per_m2 = 3.0;
    RecursiveEstimator dragged(consistent_model(), start, settings);
    settings.rate_friction.viscous.drag_N_s_per_m2 = 1e-6;
    RecursiveEstimator free(consistent_model(), start, settings);
    int all_slack = 0;
    double largest_N = 0.0;  // what the drag adds anywhere in the second cycle
    for (int step = 1; step <= 80; ++step) {
        KnownEnds ends = ends_of(start);
        ends.proximal_displacement_m += 0.02 * std::sin(2.0 * std::numbers::pi * step / 40.0);
        const RecursiveReport report = dragged.step(ends, {});
        if (free.step(ends, {}).slack + report.slack == 16) ++all_slack;
        if (step <= 40 || report.slack > 0) continue;
        for (std::size_t node = 0; node < dragged.mean_N().size(); ++node)
            largest_N = std::max(largest_N, std::abs(dragged.mean_N()[node] - free.mean_N()[node]));
    }
    EXPECT_GT(all_slack, 3);
    EXPECT_GT(largest_N, 0.1);
}

TEST(RecursiveReport, OneNumberThatIsNotFiniteIsEnoughToRefuseAStep) {
    const CableState start = pretensioned(consistent_model().cable());
    RecursiveEstimator estimator(consistent_model(), start, {});
    const double no_number = std::numeric_limits<double>::quiet_NaN();
    const KnownEnds ends = ends_of(start);
    EXPECT_THROW(estimator.step({no_number, ends.distal_displacement_m}, {}), InvalidInput);
    EXPECT_THROW(estimator.step({ends.proximal_displacement_m, no_number}, {}), InvalidInput);
    const TensionReading readings[] = {{{3, 0.0}, no_number, {}}, {{4, 0.0}, 10.0, {}}};
    EXPECT_THROW(estimator.step(ends, readings), InvalidInput);
}

TEST(RecursiveEnds, TakeAThousandAndTwentyFourMembersAndEight) {
    for (const int members : {8, 1024}) {
        RecursiveSettings settings;
        settings.members = members;
        EXPECT_NO_THROW(
            RecursiveEstimator(consistent_model(), pretensioned(consistent_model().cable()), settings));
    }
}

// Wander far below what is moved: the members follow the known ends as the model does.
TEST(RecursiveEnds, WithLittleWanderFollowTheKnownMotionOfBoth) {
    CableState truth = pretensioned(consistent_model().cable());
    const KnownEnds start = ends_of(truth);
    RecursiveSettings settings;
    settings.wander = {1e-12, 1e-12};
    RecursiveEstimator estimator(consistent_model(), truth, settings);
    for (int step = 1; step <= 60; ++step) {
        const double moved_m = 2e-4 * (step <= 20 ? step : 40 - step);  // to and fro
        const KnownEnds ends{start.proximal_displacement_m + moved_m,
                             start.distal_displacement_m + 0.4 * moved_m};
        consistent_model().advance(truth, {EndCondition::position_m(ends.proximal_displacement_m),
                                           EndCondition::position_m(ends.distal_displacement_m)});
        estimator.step(ends, {});
        for (std::size_t node = 0; node < truth.tension_N.size(); ++node)
            ASSERT_NEAR(estimator.mean_N()[node], truth.tension_N[node], 1e-3);
    }
}

// A cable that slides throughout hangs on the distance of its ends: what one end does and what the other does
// add up as independent numbers do.
TEST(RecursiveEnds, WanderIndependentlyOfEachOther) {
    const QuasiStaticStep& model = consistent_model();
    CableState sliding = pretensioned(model.cable());
    for (int step = 0; step < 3; ++step) {
        const KnownEnds ends = ends_of(sliding);
        model.advance(sliding, {EndCondition::position_m(ends.proximal_displacement_m + 0.01),
                                EndCondition::position_m(ends.distal_displacement_m + 0.01)});
    }
    const auto variance_N2 = [&](const EndWander& wander, std::uint64_t seed) {
        RecursiveSettings settings;
        settings.members = 1024;
        settings.seed = seed;
        settings.wander = wander;
        RecursiveEstimator estimator(model, sliding, settings);
        KnownEnds ends = ends_of(sliding);
        ends.proximal_displacement_m += 0.01;
        ends.distal_displacement_m += 0.01;
        estimator.step(ends, {});
        return std::pow(estimator.deviation_N()[5], 2);
    };
    const double alone_N2 = variance_N2({1e-5, 0.0}, 1) + variance_N2({0.0, 1e-5}, 1);
    double sum_N2 = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) sum_N2 += variance_N2({1e-5, 1e-5}, seed) / 20.0;
    EXPECT_NEAR(sum_N2 / alone_N2, 1.0, 0.25);
}

constexpr double stride_m = 0.01;  // of both ends in a step: far more than makes the complete cable slide

CableState sliding_cable() {
    CableState state = pretensioned(consistent_model().cable());
    for (int step = 0; step < 3; ++step)
        consistent_model().advance(state, {EndCondition::position_m(state.displacement_m.front() + stride_m),
                                           EndCondition::position_m(state.displacement_m.back() + stride_m)});
    return state;
}

// An estimator of the sliding cable after one more step, with a reading at a node.
RecursiveEstimator corrected(const CableState& start, double wander_m, int node, double value_N) {
    RecursiveSettings settings;
    settings.wander.distal_m = wander_m;
    RecursiveEstimator estimator(consistent_model(), start, settings);
    const TensionReading reading{
        spot_of_node(consistent_model().cable(), node), value_N, {.additive_N = 1e-3}};
    estimator.step({start.displacement_m.front() + stride_m, start.displacement_m.back() + stride_m},
                   std::span(&reading, 1));
    return estimator;
}

// The cable slides on as long as it was: so its tensions stay what the correction made them.
TEST(RecursiveCorrection, OfASlidingCableStaysWhileItSlidesOn) {
    const CableState start = sliding_cable();
    for (const double factor : {0.9, 1.1}) {
        RecursiveEstimator estimator = corrected(start, 1e-5, 4, factor * start.tension_N[4]);
        const std::vector<double> before(estimator.mean_N().begin(), estimator.mean_N().end());
        EXPECT_NEAR(before[4], factor * start.tension_N[4], 0.01 * start.tension_N[4]);
        estimator.step(
            {start.displacement_m.front() + 2 * stride_m, start.displacement_m.back() + 2 * stride_m}, {});
        for (int node = 0; node <= 10; ++node)
            EXPECT_NEAR(estimator.mean_N()[node], before[node], 2e-3 * before[node]);
    }
}

// A reading far below zero leaves a cable without tension that is as long as one: pulled, it is as taut as
// the model's own.
TEST(RecursiveCorrection, ThatLeavesNoTensionLeavesTheLengthOfASlackCable) {
    const CableState start = sliding_cable();
    RecursiveEstimator estimator = corrected(start, 1e-5, 4, -1000.0);
    for (const double mean_N : estimator.mean_N()) EXPECT_EQ(mean_N, 0.0);
    CableState slack = start;
    const double proximal_m = start.displacement_m.front() + stride_m;
    std::fill(slack.tension_N.begin(), slack.tension_N.end(), 0.0);
    std::fill(slack.displacement_m.begin(), slack.displacement_m.end(), proximal_m);
    slack.last_motion = {};
    slack.last_motion.kind = MotionKind::slack;
    const double pull_m = 2e-3;
    consistent_model().advance(
        slack, {EndCondition::position_m(proximal_m - pull_m), EndCondition::position_m(proximal_m)});
    estimator.step({proximal_m - pull_m, start.displacement_m.back() + stride_m}, {});
    for (int node = 0; node <= 10; ++node)
        EXPECT_NEAR(estimator.mean_N()[node], slack.tension_N[node], 0.01 * slack.tension_N[0]);
}

}  // namespace
}  // namespace capstan
