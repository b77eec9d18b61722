#include "capstan/search/shared_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

constexpr double unreachable_N = std::numeric_limits<double>::infinity();

struct Partial {
    double sum_N = 0.0;
    std::vector<int> sensors;  // of the cables so far
};

// best[n]: the smallest sum with at most n sensors, no cable's error above `limit_N`.
std::vector<Partial> smallest_sums(const std::vector<std::vector<double>>& error_N, int sensors,
                                   double limit_N) {
    std::vector<Partial> best(static_cast<std::size_t>(sensors) + 1);
    for (const std::vector<double>& cable : error_N) {
        std::vector<Partial> next(best.size(), {unreachable_N, {}});
        for (std::size_t n = 0; n < best.size(); ++n) {
            for (std::size_t own = 0; own <= n && own < cable.size(); ++own) {
                const double sum_N = best[n - own].sum_N + cable[own];
                if (cable[own] > limit_N || !(sum_N < next[n].sum_N)) continue;
                next[n] = {sum_N, best[n - own].sensors};
                next[n].sensors.push_back(static_cast<int>(own));
            }
        }
        best = std::move(next);
    }
    return best;
}

// best[n]: the smallest possible largest error with at most n sensors.
std::vector<double> smallest_largest_N(const std::vector<std::vector<double>>& error_N, int sensors) {
    std::vector<double> best(static_cast<std::size_t>(sensors) + 1, 0.0);
    for (const std::vector<double>& cable : error_N) {
        std::vector<double> next(best.size(), unreachable_N);
        for (std::size_t n = 0; n < best.size(); ++n)
            for (std::size_t own = 0; own <= n && own < cable.size(); ++own)
                next[n] = std::min(next[n], std::max(best[n - own], cable[own]));
        best = std::move(next);
    }
    return best;
}

BudgetShare allotment_of(const std::vector<std::vector<double>>& error_N, const Partial& partial) {
    BudgetShare share{partial.sensors, partial.sum_N / static_cast<double>(error_N.size()), 0.0};
    for (std::size_t c = 0; c < error_N.size(); ++c)
        share.largest_N = std::max(share.largest_N, error_N[c][static_cast<std::size_t>(partial.sensors[c])]);
    return share;
}

}  // namespace

std::vector<BudgetShare> shared_budget(const std::vector<std::vector<double>>& error_N, int sensors,
                                       BudgetObjective objective) {
    std::vector<Partial> best = smallest_sums(error_N, sensors, unreachable_N);
    if (objective == BudgetObjective::largest) {
        const std::vector<double> limits_N = smallest_largest_N(error_N, sensors);
        for (int n = 0; n <= sensors; ++n)
            best[static_cast<std::size_t>(n)] =
                smallest_sums(error_N, n, limits_N[static_cast<std::size_t>(n)]).back();
    }
    if (!std::isfinite(best.back().sum_N))
        throw InvalidInput({"the constraints of the configurations need more sensors than the budget has"});
    std::vector<BudgetShare> shares;
    for (const Partial& each : best)
        if (std::isfinite(each.sum_N)) shares.push_back(allotment_of(error_N, each));
    return shares;
}

std::vector<const CountAnswer*> best_by_count(const PlacementAnswer& found, int sensors) {
    std::vector<const CountAnswer*> best(static_cast<std::size_t>(sensors), nullptr);
    for (const ScopeAnswer& scope : found.scopes) {
        if (scope.scope != "duty_cycle") continue;
        for (const CountAnswer& count : scope.counts)
            if (count.sensors <= sensors) best[static_cast<std::size_t>(count.sensors) - 1] = &count;
    }
    return best;
}

}  // namespace capstan
