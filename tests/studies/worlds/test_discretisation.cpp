// How much of every stated error comes from the number of segments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "capstan/config/config_reader.h"
#include "capstan/worlds/stored_worlds.h"
#include "world_plans.h"

namespace capstan {
namespace {

StudyPlan shipped(const std::string& name) {
    return config::read_config(CONFIGS_FOLDER "/" + name).plan;
}

double largest_fraction(const WorldAnswer& answer) {
    const auto fraction = [](const Expected& expected) {
        return std::abs(expected.discretisation_N) / expected.objective.value_N;
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
    EXPECT_EQ(answer.best().expected.discretisation_N, grid.error_N);
    EXPECT_NEAR(grid.error_N, (grid.coarse_N - grid.finer_N) / (1.0 - std::exp2(-grid.order)), 1e-12);
}

TEST(SlowDiscretisation, IsBelowATenthOfEveryErrorThatAShippedConfigurationStates) {
    int configurations = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CONFIGS_FOLDER)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".toml" || name.starts_with("bench-")) continue;
        const StudyPlan plan = shipped(name);
        if (!plan.uncertainty.is_stated) continue;
        ++configurations;
        const double fraction = largest_fraction(run_worlds(plan, {}));
        std::printf("%s: at most %.1f%% of an error is discretisation\n", name.c_str(), 100.0 * fraction);
        EXPECT_LT(fraction, 0.1) << name;
    }
    EXPECT_GE(configurations, 5);
}

}  // namespace
}  // namespace capstan
