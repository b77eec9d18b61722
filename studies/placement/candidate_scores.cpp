#include "capstan/placement/candidate_scores.h"

#include <algorithm>
#include <map>

namespace capstan {

std::vector<PlacementCandidate> placement_candidates(const storage::StudyDescription& study,
                                                     const std::vector<storage::CellSummary>& cells) {
    std::vector<PlacementCandidate> candidates;
    std::map<std::pair<int, std::string>, std::size_t> place;
    for (const storage::CellSummary& cell : cells) {
        const auto method = std::find_if(study.fusion_methods.begin(), study.fusion_methods.end(),
                                         [&](const auto& m) { return m.method == cell.method; });
        if (method == study.fusion_methods.end() || method->knowledge == "direction_known") continue;
        const auto [found, is_new] = place.try_emplace({cell.set_index, cell.method}, candidates.size());
        if (is_new) {
            const int count = static_cast<int>(study.sensor_sets[cell.set_index].nodes.size());
            candidates.push_back({cell.set_index, count, cell.method, {}, {}});
        }
        PlacementCandidate& candidate = candidates[found->second];  // cells come in scenario order
        candidate.error_N.push_back(cell.mean_abs_error_N);
        candidate.block_error_N.push_back(cell.block_mean_abs_error_N);
    }
    return candidates;
}

std::vector<Score> weighted_scores(const std::vector<PlacementCandidate>& candidates,
                                   const std::vector<double>& fraction) {
    std::vector<Score> scores;
    for (const PlacementCandidate& candidate : candidates) {
        Score score;
        score.block_objective_N.assign(candidate.block_error_N.front().size(), 0.0);
        for (std::size_t s = 0; s < fraction.size(); ++s) {
            score.objective_N += fraction[s] * candidate.error_N[s];
            for (std::size_t b = 0; b < score.block_objective_N.size(); ++b) {
                score.block_objective_N[b] += fraction[s] * candidate.block_error_N[s][b];
            }
        }
        scores.push_back(std::move(score));
    }
    return scores;
}

std::vector<int> best_of_regimes(const std::vector<PlacementCandidate>& candidates,
                                 const std::vector<std::vector<double>>& regime_fraction) {
    std::vector<int> best;
    for (const std::vector<double>& fraction : regime_fraction) {
        const std::vector<Score> scores = weighted_scores(candidates, fraction);
        const auto best_score =
            std::min_element(scores.begin(), scores.end(),
                             [](const Score& a, const Score& b) { return a.objective_N < b.objective_N; });
        best.push_back(static_cast<int>(best_score - scores.begin()));
    }
    return best;
}

std::vector<Score> regret_scores(const std::vector<PlacementCandidate>& candidates,
                                 const std::vector<std::vector<double>>& regime_fraction,
                                 const std::vector<int>& reference) {
    std::vector<Score> worst(candidates.size());
    for (std::size_t regime = 0; regime < regime_fraction.size(); ++regime) {
        const std::vector<Score> scores = weighted_scores(candidates, regime_fraction[regime]);
        for (std::size_t c = 0; c < scores.size(); ++c) {
            Score regret = difference_of(scores[c], scores[reference[regime]]);
            if (regime == 0 || regret.objective_N > worst[c].objective_N) worst[c] = std::move(regret);
        }
    }
    return worst;
}

}  // namespace capstan
