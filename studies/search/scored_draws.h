#pragma once

#include <vector>

#include "capstan/placement/single_sensor_stage.h"
#include "capstan/search/placement_scope.h"

namespace capstan {

/// Consecutive draws of all scenarios and the errors that all candidates make on them. More can be added: the
/// old ones stay, and the weights of the W methods stay those of the first.
class ScoredDraws {
  public:
    /// `first_draw`: 0 for the study's own, `independent_draws` for others. Both references must outlive it.
    ScoredDraws(const PreparedStudy& study, int noise_index, std::uint32_t first_draw,
                const CandidateList& candidates, PlacementObjective objective);

    /// Weights of the W methods, from the single-sensor errors of the study's own draws. scenarios x nodes.
    static std::vector<std::vector<double>> weights(const PreparedStudy& study, int noise_index, int jobs);

    /// Draws, solves and scores until there are all of these blocks. Those that are there already must be
    /// full.
    void extend(const DrawBlocks& blocks, const std::vector<std::vector<double>>& weights, int jobs);

    const DrawBlocks& blocks() const { return blocks_; }
    const std::vector<ScenarioErrors>& scenarios() const { return scenarios_; }

  private:
    const PreparedStudy& study_;
    int noise_index_;
    std::uint32_t first_draw_;
    const CandidateList& candidates_;
    PlacementObjective objective_;
    DrawBlocks blocks_;
    std::vector<BlockErrors> errors_;        // scenarios
    std::vector<ScenarioErrors> scenarios_;  // scenarios
};

}  // namespace capstan
