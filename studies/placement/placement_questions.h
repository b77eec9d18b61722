#pragma once

#include <string>
#include <vector>

#include "capstan/placement/candidate_scores.h"
#include "capstan/storage/records.h"

namespace capstan {

/// What is asked of a stored study at one noise level, and how each candidate answers.
struct PlacementQuestion {
    std::string scope;          ///< "regime", "minimax_regret" or "duty_cycle"
    std::string regime;         ///< "regime" only
    std::vector<Score> scores;  // candidates
};

/// The scenarios that each question weighs, with shares that sum to one.
struct ScenarioShares {
    std::vector<std::vector<double>> regime;  // regimes x scenarios
    std::vector<double> duty;                 // scenarios
};

ScenarioShares scenario_fractions(const storage::StudyDescription& study);

/// Every regime, minimax regret, duty cycle. `reference` is the candidate from which the regret of each
/// regime is measured: best_of_regimes().
std::vector<PlacementQuestion> placement_questions(const std::vector<PlacementCandidate>& candidates,
                                                   const storage::StudyDescription& study,
                                                   const ScenarioShares& fractions,
                                                   const std::vector<int>& reference);

}  // namespace capstan
