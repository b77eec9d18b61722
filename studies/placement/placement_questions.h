#pragma once

#include <span>
#include <string>
#include <vector>

#include "capstan/placement/candidate_scores.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/storage/records.h"

namespace capstan {

/// A question about a stored study at one noise level, and the score of each candidate.
struct PlacementQuestion {
    std::string scope;          ///< "regime", "minimax_regret" or "duty_cycle"
    std::string regime;         ///< "regime" only
    std::vector<Score> scores;  // candidates
};

/// The weights of the scenarios in each question; they sum to one.
struct ScenarioFractions {
    std::vector<std::vector<double>> regime;  // regimes x scenarios
    std::vector<double> duty;                 // scenarios
};

ScenarioFractions scenario_fractions(const storage::StudyDescription& study);
ScenarioFractions scenario_fractions(const PreparedStudy& study);

/// Every regime, minimax regret, duty cycle. `reference` is the candidate from which the regret of each
/// regime is measured: best_of_regimes().
std::vector<PlacementQuestion> placement_questions(const std::vector<PlacementCandidate>& candidates,
                                                   const storage::StudyDescription& study,
                                                   const ScenarioFractions& fractions,
                                                   const std::vector<int>& reference);

/// The smallest error [N] that a number of sensors reaches.
struct CountError {
    int sensors = 0;
    double error_N = 0.0;
};

/// The smallest count from which no larger one gains more than `worthwhile_gain_N` per sensor added; 0
/// without counts. `by_count` is in rising order.
int count_where_gain_flattens(std::span<const CountError> by_count, double worthwhile_gain_N);

}  // namespace capstan
