// One budget of sensors for several cables.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>

#include "capstan/cable/invalid_input.h"
#include "capstan/search/shared_budget.h"

namespace capstan {
namespace {

using Errors = std::vector<std::vector<double>>;
constexpr double never = std::numeric_limits<double>::infinity();

// {largest, sum} or {sum, 0}: the smallest over all distributions.
std::pair<double, double> by_trying_all(const Errors& error_N, int sensors, BudgetObjective objective) {
    std::pair best{never, never};
    const std::function<void(std::size_t, int, double, double)> go = [&](std::size_t cable, int left,
                                                                         double sum, double largest) {
        if (cable == error_N.size()) {
            best = std::min(
                best, objective == BudgetObjective::mean ? std::pair{sum, 0.0} : std::pair{largest, sum});
            return;
        }
        for (int own = 0; own <= left && own < static_cast<int>(error_N[cable].size()); ++own) {
            const double error = error_N[cable][static_cast<std::size_t>(own)];
            go(cable + 1, left - own, sum + error, std::max(largest, error));
        }
    };
    go(0, sensors, 0.0, 0.0);
    return best;
}

TEST(SharedBudget, IsTheBestOfAllDistributions) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> error(0.0, 1.0);
    for (int trial = 0; trial < 200; ++trial) {
        Errors error_N(1 + trial % 4);
        for (auto& cable : error_N)
            for (int k = 0; k <= 4; ++k) cable.push_back(trial % 3 == 0 && k == 0 ? never : error(random));
        for (const BudgetObjective objective : {BudgetObjective::mean, BudgetObjective::largest}) {
            const BudgetShare share = shared_budget(error_N, 6, objective).back();
            const auto best = by_trying_all(error_N, 6, objective);
            const double sum_N = share.mean_N * static_cast<double>(error_N.size());
            EXPECT_NEAR(objective == BudgetObjective::mean ? sum_N : share.largest_N, best.first, 1e-12);
            if (objective == BudgetObjective::largest) {
                EXPECT_NEAR(sum_N, best.second, 1e-12);
            }
        }
    }
}

TEST(SharedBudget, GivesTheSensorToTheCableThatGainsMost) {
    const Errors error_N{{1.0, 0.9, 0.8}, {1.0, 0.2, 0.1}};
    const auto shares = shared_budget(error_N, 2, BudgetObjective::mean);
    EXPECT_EQ(shares[1].sensors, (std::vector{0, 1}));
    EXPECT_EQ(shares[2].sensors, (std::vector{1, 1}));
    EXPECT_EQ(shared_budget(error_N, 2, BudgetObjective::largest)[2].sensors, (std::vector{1, 1}));
}

TEST(SharedBudget, LeavesASensorOutThatDoesNotHelp) {
    EXPECT_EQ(shared_budget({{0.5, 0.1, 0.1}}, 2, BudgetObjective::mean).back().sensors, (std::vector{1}));
}

TEST(SharedBudget, RefusesABudgetThatIsTooSmall) {
    EXPECT_THROW(shared_budget({{never, 0.1}, {never, 0.1}}, 1, BudgetObjective::mean), InvalidInput);
    EXPECT_EQ(shared_budget({{never, 0.1}, {never, 0.1}}, 3, BudgetObjective::mean).size(),
              2);  // with 2 and with 3
}

}  // namespace
}  // namespace capstan
