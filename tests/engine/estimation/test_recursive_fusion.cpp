#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/recursive_fusion.h"
#include "example_cables.h"

namespace capstan {
namespace {

double moved_proximal_m(const Cable& cable, int step) {
    return pretensioned(cable).displacement_m.front() + 0.006 * std::sin(2.0 * std::numbers::pi * step / 100);
}

// Mean error over the first quarter cycle and all nodes, distal end blocked, readings without noise.
double mean_error_N(const FusionMethod& method, const std::vector<int>& sensors, double factor,
                    const std::vector<double>& weight = {}) {
    const QuasiStaticStep model(test::paper_cable(10), ModelRules::consistent());
    CableState truth = pretensioned(model.cable());
    RecursiveFusion fusion(model, truth, method, DistalSide::excluded, weight);
    double sum_N = 0.0;
    int count = 0;
    for (int step = 1; step <= 25; ++step) {
        const double near_m = moved_proximal_m(model.cable(), step);
        model.advance(truth, {EndCondition::position_m(near_m), EndCondition::position_m(0.0)});
        std::vector<NodeReading> readings;
        for (const int node : sensors)
            readings.push_back({node, factor * truth.tension_N[static_cast<std::size_t>(node)]});
        fusion.step(near_m, readings);
        for (std::size_t node = 0; node < truth.tension_N.size(); ++node) {
            sum_N += std::abs(fusion.estimate().tension_N[node] - truth.tension_N[node]);
            ++count;
        }
    }
    return sum_N / count;
}

TEST(RecursiveFusion, WithOneSensorMeanAndMeanRAreTheSame) {
    EXPECT_EQ(mean_error_N(mean_method, {0}, 1.05), mean_error_N(mean_r_method, {0}, 1.05));
}

TEST(RecursiveFusion, WithEqualWeightsWMeanIsMean) {
    const std::vector<double> equal(11, 0.25);
    EXPECT_EQ(mean_error_N(weighted_mean_method, {0, 1, 10}, 1.05, equal),
              mean_error_N(mean_method, {0, 1, 10}, 1.05));
}

TEST(RecursiveFusion, AWeightOfNearlyOneMakesTheSensorsEstimateTheFusedOne) {
    std::vector<double> weight(11, 1e-12);
    weight[1] = 1.0;
    EXPECT_NEAR(mean_error_N(weighted_mean_method, {1, 10}, 1.05, weight),
                mean_error_N(mean_method, {1}, 1.05), 1e-6);
}

// With equal weights both leave out the same estimates; W Mean-R does not make up for their tensions.
TEST(RecursiveFusion, WMeanRMovesTheCableAsMeanRDoes) {
    const QuasiStaticStep model(test::paper_cable(10), ModelRules::consistent());
    const CableState start = pretensioned(model.cable());
    const std::vector<double> weight(11, 1.0);
    CableState truth = start;
    const double near_m = moved_proximal_m(model.cable(), 8);
    model.advance(truth, {EndCondition::position_m(near_m), EndCondition::position_m(0.0)});
    int disagreements = 0;
    for (int variant = 0; variant < 44; ++variant) {
        const double factor = 0.5 + 0.05 * (variant / 2);
        const bool far_sensors_err = variant % 2 == 0;
        RecursiveFusion shared(model, start, mean_r_method, DistalSide::admitted);
        RecursiveFusion unshared(model, start, weighted_mean_r_method, DistalSide::admitted, weight);
        std::vector<NodeReading> readings;
        for (const int node : {0, 2, 4, 8, 10})
            readings.push_back({node, truth.tension_N[static_cast<std::size_t>(node)] *
                                          ((node > 3) == far_sensors_err ? factor : 1.0)});
        shared.step(near_m, readings);
        unshared.step(near_m, readings);
        if (shared.estimate().tension_N != unshared.estimate().tension_N) ++disagreements;
        for (std::size_t node = 0; node < start.displacement_m.size(); ++node) {
            EXPECT_NEAR(unshared.estimate().displacement_m[node], shared.estimate().displacement_m[node],
                        1e-12);
        }
    }
    EXPECT_GT(disagreements, 3);
}

TEST(RecursiveFusion, ErrorsOfReadingsComeBackInTheEstimate) {
    const double exact_N = mean_error_N(mean_method, {0, 1}, 1.0);
    const double off_N = mean_error_N(mean_method, {0, 1}, 1.2);
    EXPECT_GT(off_N, exact_N);
}

TEST(RecursiveFusion, WhereNoPatternVerifiesTheStateStays) {
    const QuasiStaticStep model(test::paper_cable(10), ModelRules::consistent());
    const CableState start = pretensioned(model.cable());
    RecursiveFusion fusion(model, start, mean_method, DistalSide::excluded);
    const NodeReading pushes[] = {{0, -50.0}, {10, -50.0}};
    EXPECT_EQ(fusion.step(moved_proximal_m(model.cable(), 1), pushes), 2);
    EXPECT_EQ(fusion.estimate().tension_N, start.tension_N);
    EXPECT_EQ(fusion.estimate().displacement_m, start.displacement_m);
    EXPECT_EQ(fusion.estimate().last_motion.kind, MotionKind::rest);
}

TEST(RecursiveFusion, RefusesWeightsNoReadingsAndNodesBeyondTheCable) {
    const QuasiStaticStep model(test::paper_cable(10), ModelRules::consistent());
    const CableState start = pretensioned(model.cable());
    EXPECT_THROW(RecursiveFusion(model, start, weighted_mean_method, DistalSide::excluded), InvalidInput);
    EXPECT_THROW(RecursiveFusion(model, start, weighted_mean_r_method, DistalSide::excluded), InvalidInput);
    EXPECT_THROW(RecursiveFusion(model, start, mean_known_direction, DistalSide::excluded), InvalidInput);
    EXPECT_THROW(RecursiveFusion(model, start, posterior_mean_method, DistalSide::excluded), InvalidInput);
    RecursiveFusion fusion(model, start, mean_method, DistalSide::excluded);
    EXPECT_THROW(fusion.step(0.0, {}), InvalidInput);
    const NodeReading beyond{11, 10.0};
    EXPECT_THROW(fusion.step(0.0, {&beyond, 1}), InvalidInput);
}

TEST(RecursiveFusion, RefusesMorePatternsThanItCanTry) {
    const QuasiStaticStep model(test::paper_cable(max_estimated_segments + 1), ModelRules::consistent());
    const CableState start = pretensioned(model.cable());
    EXPECT_THROW(RecursiveFusion(model, start, mean_method, DistalSide::admitted), InvalidInput);
}

TEST(RecursiveFusion, TakesAsManySegmentsAsAWordHolds) {
    const QuasiStaticStep model(test::paper_cable(max_estimated_segments), ModelRules::consistent());
    CableState truth = pretensioned(model.cable());
    RecursiveFusion fusion(model, truth, mean_r_method, DistalSide::excluded);
    const double near_m = moved_proximal_m(model.cable(), 5);
    model.advance(truth, {EndCondition::position_m(near_m), EndCondition::position_m(0.0)});
    const NodeReading readings[] = {{0, truth.tension_N.front()}, {2, truth.tension_N[2]}};
    fusion.step(near_m, readings);
    EXPECT_EQ(fusion.estimate().tension_N.back(), truth.tension_N.back());
}

// To and fro with a spring at the far end: rest, motion from the near end, all of the cable, and back.
void expect_finite_estimates(int segments) {
    const QuasiStaticStep model(test::paper_cable(segments), ModelRules::consistent());
    CableState truth = pretensioned(model.cable());
    RecursiveFusion fusion(model, truth, mean_r_method, DistalSide::admitted);
    std::set<MotionKind> seen;
    for (int step = 1; step <= 200; ++step) {
        const double near_m = moved_proximal_m(model.cable(), step);
        const double far_m = step > 100 ? 1e-3 * std::sin(0.2 * step) : 0.0;
        model.advance(truth, {EndCondition::position_m(near_m), EndCondition::position_m(far_m)});
        seen.insert(truth.last_motion.kind);
        std::vector<NodeReading> readings;
        for (int node = 0; node <= segments; ++node)
            readings.push_back({node, truth.tension_N[static_cast<std::size_t>(node)]});
        fusion.step(near_m, readings);
        for (std::size_t node = 0; node < truth.tension_N.size(); ++node)
            ASSERT_TRUE(std::isfinite(fusion.estimate().tension_N[node]));
    }
    EXPECT_GE(seen.size(), 3u);
}

TEST(RecursiveFusion, StaysFiniteThroughEveryKindOfMotionOfTheTruth) {
    for (const int segments : {6, 8}) expect_finite_estimates(segments);
}

}  // namespace
}  // namespace capstan
