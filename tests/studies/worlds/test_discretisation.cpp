// How much of every stated error comes from the number of segments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "capstan/config/config_reader.h"
#include "capstan/worlds/paired_worlds.h"
#include "capstan/worlds/stored_worlds.h"
#include "world_plans.h"

namespace capstan {
namespace {

StudyPlan shipped(const std::string& name) {
    return config::read_config(CONFIGS_FOLDER "/" + name).plan;
}

double largest_fraction(const WorldAnswer& answer) {
    const auto fraction = [](const Expected& expected) {
        return std::max(std::abs(expected.discretisation_N) / expected.objective.value_N,
                        std::abs(expected.error_95_discretisation_N) / expected.error_95_N);
    };
    double largest = fraction(answer.no_sensor);
    for (const PriceBest& best : answer.prices) largest = std::max(largest, fraction(best.expected));
    for (const Expected& baseline : answer.baselines) largest = std::max(largest, fraction(baseline));
    return largest;
}

StudyPlan noise_sweep_with(double static_friction) {
    StudyPlan plan = shipped("noise-sweep.toml");
    plan.repetitions = 40;
    plan.transmission.cable.static_friction = static_friction;
    return plan;
}

// By which fraction twice the segments lower the error of sensors at both ends.
double fraction_of_finer_grid(const StudyPlan& plan) {
    ErrorTable table(plan, {});
    const int both_ends = table.candidate_of({0, static_cast<int>(table.offers().size()) - 1});
    double coarse_N = 0.0;
    double difference_N = 0.0;
    for (const Condition condition : {Condition::as_stated, Condition::finer_grid})
        table.fill(condition, std::vector{both_ends}, 0, plan.repetitions, "test");
    for (int world = 0; world < plan.repetitions; ++world) {
        const double error_N = table.at(Condition::as_stated, both_ends, world).mean_abs_N;
        coarse_N += error_N;
        difference_N += error_N - table.at(Condition::finer_grid, both_ends, world).mean_abs_N;
    }
    return difference_N / coarse_N;
}

// Friction beyond the dynamic one delays each segment by itself, so it counts less with more segments.
TEST(Discretisation, IsThatOfStaticFrictionBeyondTheDynamicOne) {
    EXPECT_LT(std::abs(fraction_of_finer_grid(noise_sweep_with(0.21))), 0.03);
    EXPECT_GT(fraction_of_finer_grid(noise_sweep_with(0.63)), 0.05);
}

TEST(Discretisation, IsRichardsonsExtrapolationOfTwoFinerGrids) {
    const WorldAnswer answer = run_worlds(noise_sweep_with(0.63), {});
    const GridError& grid = answer.grid;
    EXPECT_EQ(grid.worlds, 20);
    EXPECT_GT(grid.coarse_N, grid.finer_N);
    EXPECT_GT(grid.finer_N, grid.finest_N);
    const Expected& stated = answer.recommended ? answer.best().expected : answer.no_sensor;
    EXPECT_NEAR(stated.discretisation_N,
                (grid.coarse_N - grid.finest_N) / (1.0 - std::exp2(-2.0 * grid.order)), 1e-12);
    EXPECT_GT(stated.error_95_discretisation_N, 0.0);
}

// The errors of worlds fall from e to e / 2 + 1, and so does each quantile of them.
TEST(Discretisation, AQuantileFallsAsTheWorldsNearIt) {
    std::vector<double> from_N, to_N;
    for (int world = 0; world < 40; ++world) {
        from_N.push_back(2.0 + 0.1 * world);
        to_N.push_back(0.5 * from_N.back() + 1.0);
    }
    for (const double fraction : {0.5, 0.95}) {
        const double fall_N = quantile_of(from_N, fraction) - quantile_of(to_N, fraction);
        const double middle_N = 0.5 * (quantile_of(from_N, fraction) + quantile_of(to_N, fraction));
        EXPECT_NEAR(fall_near(middle_N, from_N, to_N), fall_N, 1e-12);
    }
}

// With the segments that a shipped configuration states, and with those that it gets where it states none.
class SlowDiscretisation : public ::testing::TestWithParam<bool> {};

TEST_P(SlowDiscretisation, IsBelowATenthOfEveryErrorThatAShippedConfigurationStates) {
    int configurations = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CONFIGS_FOLDER)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".toml" || name.starts_with("bench-")) continue;
        StudyPlan plan = shipped(name);
        if (!plan.uncertainty.is_stated) continue;
        ++configurations;
        if (GetParam()) {
            plan.transmission.cable.segments = default_segments(plan);
            plan.explicit_layouts.clear();
        }
        const double fraction = largest_fraction(run_worlds(plan, {}));
        std::printf("%s, %d segments: at most %.1f%% of an error is discretisation\n", name.c_str(),
                    plan.transmission.cable.segments, 100.0 * fraction);
        EXPECT_LT(fraction, 0.1) << name;
    }
    EXPECT_GE(configurations, 5);
}

INSTANTIATE_TEST_SUITE_P(SlowSegmentsByRule, SlowDiscretisation, ::testing::Bool());

}  // namespace
}  // namespace capstan
