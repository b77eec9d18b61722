#pragma once

#include <vector>

#include "capstan/search/placement_answer.h"

namespace capstan {

/// What is to be small over several cables.
enum class BudgetObjective {
    mean,     ///< the mean of the cables' errors
    largest,  ///< the largest of them; among equal ones the mean
};

/// How many sensors each cable gets, and what that leaves [N].
struct BudgetShare {
    std::vector<int> sensors;  // cables
    double mean_N = 0.0;
    double largest_N = 0.0;
};

/// The best distribution of at most `sensors` over cables, for every number up to `sensors` that is enough.
/// `error_N[c][k]` is the error of cable c with k sensors; infinite where the constraints allow no such
/// layout. Exact, by dynamic programming over the cables; a smaller number of sensors wins where more do not
/// help. Throws InvalidInput if some cable allows no layout.
std::vector<BudgetShare> shared_budget(const std::vector<std::vector<double>>& error_N, int sensors,
                                       BudgetObjective objective);

/// Of a search over a cable's layouts: the best ones over the duty cycle, by number of sensors from 1; null
/// where the constraints allow none.
std::vector<const CountAnswer*> best_by_count(const PlacementAnswer& found, int sensors);

}  // namespace capstan
