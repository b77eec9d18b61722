#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/search/sensor_placement.h"
#include "every_layout.h"

namespace capstan {
namespace {

using test::EveryLayout;

const ScopeAnswer& scope_of(const PlacementAnswer& answer, std::string_view name,
                            std::string_view regime = "") {
    return *std::find_if(answer.scopes.begin(), answer.scopes.end(), [&](const ScopeAnswer& scope) {
        return scope.scope == name && scope.regime == regime;
    });
}

using test::alone;

// Looks at every layout itself, with the errors that the search had.
TEST(SensorPlacement, OptimumIsTheBestAllowedLayout) {
    StudyPlan plan = test::short_cable_plan(40);
    plan.placement.forbidden_nodes = {1};
    plan.placement.minimum_spacing = 2;
    const PlacementAnswer answer = place_sensors(plan, alone());
    EveryLayout every(plan);
    every.draws.extend({40, 1}, every.weights, 1);
    const PlacementConstraints constraints(plan.placement, every.study.nodes());
    const auto& mass = every.draws.scenarios()[0].error_N;
    for (const CountAnswer& count : scope_of(answer, "regime", "mass").counts) {
        double best_N = 1e9;
        for (int c = every.candidates.of(1, 0); c < every.candidates.count(); ++c) {
            const std::vector<int> nodes = every.subsets.nodes_of(every.candidates.subset(c));
            if (static_cast<int>(nodes.size()) == count.sensors && constraints.allow(nodes))
                best_N = std::min(best_N, mass[c]);
        }
        EXPECT_EQ(count.optimum.searched_N, best_N);
        EXPECT_TRUE(count.optimum.breaks.empty());
    }
    EXPECT_EQ(scope_of(answer, "regime", "mass").counts.back().sensors, 3);  // 1, 3, 5
}

// 50 repetitions in at most 40 blocks leave a last block that is not full.
TEST(SensorPlacement, UsesExactlyTheRepetitionsOfThePlan) {
    for (const int repetitions : {50, 77, 100}) {
        const StudyPlan plan = test::short_cable_plan(repetitions);
        const PlacementAnswer answer = place_sensors(plan, alone());
        EXPECT_EQ(answer.repetitions, repetitions);
        EveryLayout every(plan);
        every.draws.extend({repetitions, 1}, every.weights, 1);
        const JudgedLayout& optimum = scope_of(answer, "regime", "mass").counts.front().optimum;
        EXPECT_NEAR(optimum.searched_N, every.draws.scenarios()[0].error_N[optimum.candidate], 1e-12);
    }
}

TEST(SensorPlacement, NoComparedLayoutIsBetterOnTheDrawsOfTheSearch) {
    const PlacementAnswer answer = place_sensors(test::short_cable_plan(60), alone());
    for (const ScopeAnswer& scope : answer.scopes) {
        ASSERT_EQ(scope.counts.size(), 5u);
        for (const CountAnswer& count : scope.counts) {
            EXPECT_EQ(count.beside.size(), 6u);  // three families, greedy both ways, D-optimal
            double before_N = count.optimum.searched_N;
            for (const JudgedLayout& next : count.runners_up) {
                EXPECT_GE(next.searched_N, before_N);
                before_N = next.searched_N;
            }
            for (const JudgedLayout& other : count.beside)
                EXPECT_GE(other.searched_N, count.optimum.searched_N);
        }
    }
}

TEST(SensorPlacement, GreedyForwardIsOptimalForOneSensor) {
    const PlacementAnswer answer = place_sensors(test::short_cable_plan(40), alone());
    for (const ScopeAnswer& scope : answer.scopes) {
        const auto& beside = scope.counts.front().beside;
        const auto greedy = std::find_if(beside.begin(), beside.end(), [](const JudgedLayout& layout) {
            return layout.how == "greedy_forward";
        });
        ASSERT_NE(greedy, beside.end());
        EXPECT_EQ(greedy->nodes, scope.counts.front().optimum.nodes);
    }
}

// The draws that chose the best of many candidates are optimistic about it. Averaged over studies, because
// the difference in a single study can have either sign.
TEST(SensorPlacement, OptimumIsWorseOnIndependentDrawsOnAverage) {
    double optimism_N = 0.0;
    for (int seed = 1; seed <= 40; ++seed) {
        const PlacementAnswer answer = place_sensors(test::short_cable_plan(20, seed), alone());
        for (const CountAnswer& count : scope_of(answer, "duty_cycle").counts) {
            if (count.sensors == 2) optimism_N += count.optimism_N / 40.0;
        }
    }
    EXPECT_GT(optimism_N, 0.0);
}

TEST(SensorPlacement, ErrorAfterALossIsThatOfTheRemainingLayout) {
    const StudyPlan plan = test::short_cable_plan(40);
    const PlacementAnswer answer = place_sensors(plan, alone());
    EveryLayout every(plan);
    every.draws.extend({40, 1}, every.weights, 1);
    const auto& mass_N = every.draws.scenarios()[0].error_N;
    for (const CountAnswer& count : scope_of(answer, "regime", "mass").counts) {
        if (count.sensors == 1) {
            EXPECT_TRUE(std::isinf(count.optimum.after_loss_N));
            continue;
        }
        double worst_N = 0.0;
        for (std::size_t lost = 0; lost < count.optimum.nodes.size(); ++lost) {
            std::vector<int> left = count.optimum.nodes;
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(lost));
            worst_N = std::max(worst_N, mass_N[every.candidate(left, count.optimum.method)]);
        }
        EXPECT_EQ(count.optimum.after_loss_N, worst_N);
    }
}

TEST(SensorPlacement, KeepsTheLimitOnTheErrorAfterALossOrReportsTheBestPossible) {
    StudyPlan plan = test::short_cable_plan(40);
    plan.placement.largest_error_after_loss_N = 0.6;
    for (const ScopeAnswer& scope : place_sensors(plan, alone()).scopes) {
        for (const CountAnswer& count : scope.counts) EXPECT_LE(count.optimum.after_loss_N, 0.6);
    }
    plan.placement.largest_error_after_loss_N = 1e-6;
    try {
        place_sensors(plan, alone());
        FAIL() << "no layout survives so well";
    } catch (const InvalidInput& invalid) {
        EXPECT_NE(std::string(invalid.what()).find("placement.largest_error_after_loss_N"),
                  std::string::npos);
    }
}

TEST(SensorPlacement, RejectsContradictoryConstraints) {
    StudyPlan plan = test::short_cable_plan(40);
    plan.placement.required_nodes = {2, 3};
    plan.placement.minimum_spacing = 2;
    EXPECT_THROW(place_sensors(plan, alone()), InvalidInput);
}

TEST(SensorPlacement, AddsRepetitionsUntilTheOptimumIsResolved) {
    const StudyPlan plan = test::short_cable_plan(40);
    PlacementOptions options = alone();
    options.resolve_to_N = 0.15;
    int looks = 0;
    options.on_progress = [&](const std::string&) { ++looks; };
    const PlacementAnswer answer = place_sensors(plan, options);
    EXPECT_GT(looks, 1);
    EXPECT_EQ(answer.repetitions, 40 << (looks - 1));
    for (const ScopeAnswer& scope : answer.scopes) {
        for (const CountAnswer& count : scope.counts) EXPECT_LE(count.at_most_better_N, 0.15);
    }
}

TEST(SensorPlacement, AnswersEveryObjective) {
    for (const PlacementObjective objective : all_placement_objectives) {
        StudyPlan plan = test::short_cable_plan(40);
        plan.placement.objective = objective;
        const PlacementAnswer answer = place_sensors(plan, alone());
        for (const ScopeAnswer& scope : answer.scopes) {
            for (const CountAnswer& count : scope.counts) {
                EXPECT_GE(count.optimum.searched_N, 0.0);
                EXPECT_LE(count.optimum.independent.low_N, count.optimum.independent.value_N);
            }
        }
    }
}

}  // namespace
}  // namespace capstan
