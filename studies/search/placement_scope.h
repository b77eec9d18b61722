#pragma once

#include <span>
#include <string>
#include <vector>

#include "capstan/placement/intervals.h"
#include "capstan/search/subset_scores.h"

namespace capstan {

/// Errors of all candidates in one scenario, summed up [N].
struct ScenarioErrors {
    int blocks = 0;
    std::vector<double> error_N;        // candidates
    std::vector<double> block_error_N;  // candidates x blocks: of which error_N is, to first order, the mean

    std::span<const double> blocks_of(int candidate) const {
        return std::span<const double>(block_error_N)
            .subspan(static_cast<std::size_t>(candidate) * blocks, blocks);
    }
};

/// What each objective makes of the sums: a mean; the mean at the node where it is largest; a quantile, whose
/// block values are its influence function's (a quantile of a few repetitions would be biased).
ScenarioErrors summarise(const BlockErrors& errors, const CandidateList& candidates,
                         PlacementObjective objective, const DrawBlocks& blocks);

/// One question: how the errors of a candidate in all scenarios become one score. Smaller is better.
class PlacementScope {
  public:
    /// Mean over scenarios with the given fractions, which sum to one.
    PlacementScope(std::string name, std::string regime, std::vector<double> fraction);
    /// Largest regret over regimes: how much worse than the regime's reference. `regime_fraction` is regimes
    /// x scenarios; `reference` a candidate for each regime.
    PlacementScope(std::string name, std::vector<std::vector<double>> regime_fraction,
                   std::vector<int> reference);

    const std::string& name() const { return name_; }      ///< "regime", "minimax_regret" or "duty_cycle"
    const std::string& regime() const { return regime_; }  ///< "regime" only
    /// scenarios: for one mean over scenarios.
    const std::vector<double>& fraction() const { return fraction_.front(); }
    const std::vector<int>& references() const { return reference_; }

    double objective_N(const std::vector<ScenarioErrors>& scenarios, int candidate) const;
    /// The same with its block values.
    Score score(const std::vector<ScenarioErrors>& scenarios, int candidate) const;

  private:
    double regret_N(const std::vector<ScenarioErrors>& scenarios, int candidate, std::size_t regime) const;
    std::size_t worst_regime(const std::vector<ScenarioErrors>& scenarios, int candidate) const;

    std::string name_;
    std::string regime_;
    std::vector<std::vector<double>> fraction_;  // regimes (or 1) x scenarios
    std::vector<int> reference_;                 // regimes; empty: none
};

}  // namespace capstan
