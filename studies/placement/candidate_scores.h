#pragma once

#include <string>
#include <vector>

#include "capstan/placement/intervals.h"
#include "capstan/storage/records.h"
#include "capstan/storage/study_store.h"

namespace capstan {

/// A sensor set with a fusion method, and its errors in every scenario.
struct PlacementCandidate {
    int set_index = 0;
    int sensor_count = 0;
    std::string method;
    std::vector<double> error_N;                     // scenarios
    std::vector<std::vector<double>> block_error_N;  // scenarios x blocks
};

/// All candidates at one noise level, without the methods that are told the true direction.
std::vector<PlacementCandidate> placement_candidates(const storage::StudyDescription& study,
                                                     const std::vector<storage::CellSummary>& cells);

/// Mean error over scenarios with the given fractions, which sum to one.
std::vector<Score> weighted_scores(const std::vector<PlacementCandidate>& candidates,
                                   const std::vector<double>& fraction);  // scenarios

/// The best candidate of each regime, at any count. `regime_fraction` is regimes x scenarios, the fraction of
/// a regime's own scenarios.
std::vector<int> best_of_regimes(const std::vector<PlacementCandidate>& candidates,
                                 const std::vector<std::vector<double>>& regime_fraction);

/// Largest regret over regimes: how much worse than the candidate `reference` of each regime.
std::vector<Score> regret_scores(const std::vector<PlacementCandidate>& candidates,
                                 const std::vector<std::vector<double>>& regime_fraction,
                                 const std::vector<int>& reference);

}  // namespace capstan
