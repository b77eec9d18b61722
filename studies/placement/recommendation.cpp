#include "capstan/placement/recommendation.h"

#include <algorithm>
#include <map>

#include "capstan/placement/candidate_scores.h"
#include "capstan/placement/cell_statistics.h"
#include "capstan/placement/paired_comparison.h"
#include "capstan/placement/recommendation_sentence.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

// The best candidate at each count, by count.
std::map<int, int> best_by_count(const std::vector<PlacementCandidate>& candidates,
                                 const std::vector<Score>& scores) {
    std::map<int, int> best;
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
        const auto [place, is_new] = best.try_emplace(candidates[c].sensor_count, c);
        if (!is_new && scores[c].objective_N < scores[place->second].objective_N) place->second = c;
    }
    return best;
}

// The smallest count from which no larger one gains `worthwhile_gain_N` per sensor added.
int count_where_gain_flattens(const std::map<int, int>& best, const std::vector<Score>& scores,
                              double worthwhile_gain_N) {
    for (auto here = best.begin(); here != best.end(); ++here) {
        const bool flat = std::all_of(std::next(here), best.end(), [&](const auto& more) {
            const double gain_N = scores[here->second].objective_N - scores[more.second].objective_N;
            return gain_N <= worthwhile_gain_N * (more.first - here->first);
        });
        if (flat) return here->first;
    }
    return best.rbegin()->first;
}

storage::RecommendationCountRecord count_record(const PlacementCandidate& candidate, const Score& score) {
    return {candidate.sensor_count,
            candidate.set_index,
            candidate.method,
            score.objective_N,
            score.objective_N - normal_95 * score.standard_error_N,
            score.objective_N + normal_95 * score.standard_error_N};
}

// Who at the recommended count cannot be told from the recommended one.
std::vector<storage::RecommendationAlternativeRecord> indifferent_set(
    const std::vector<PlacementCandidate>& candidates, const std::vector<Score>& scores, int recommended) {
    std::vector<int> others;
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
        if (c != recommended && candidates[c].sensor_count == candidates[recommended].sensor_count) {
            others.push_back(c);
        }
    }
    std::vector<storage::RecommendationAlternativeRecord> alternatives;
    for (const PairedDifference& d : simultaneous_differences(scores, recommended, others)) {
        if (d.low_N > 0.0) continue;
        alternatives.push_back({candidates[d.candidate].set_index, candidates[d.candidate].method,
                                d.difference_N, d.low_N, d.high_N});
    }
    std::stable_sort(alternatives.begin(), alternatives.end(),
                     [](const auto& a, const auto& b) { return a.difference_N < b.difference_N; });
    return alternatives;
}

// What is asked, and how each candidate answers.
struct Question {
    std::string scope;
    std::string regime;
    std::vector<Score> scores;  // candidates
};

storage::RecommendationRecord answer(const storage::StudyDescription& study, int noise_index,
                                     const std::vector<PlacementCandidate>& candidates,
                                     const Question& question, const RecommendationPolicy& policy) {
    const std::map<int, int> best = best_by_count(candidates, question.scores);
    const int count = count_where_gain_flattens(best, question.scores, policy.worthwhile_gain_N);
    const int chosen = best.at(count);
    const storage::RecommendationCountRecord at_count =
        count_record(candidates[chosen], question.scores[chosen]);
    storage::RecommendationRecord record;
    record.noise_index = noise_index;
    record.scope = question.scope;
    record.regime = question.regime;
    record.set_index = at_count.set_index;
    record.method = at_count.method;
    record.sensor_count = count;
    record.error_N = at_count.error_N;
    record.interval_low_N = at_count.interval_low_N;
    record.interval_high_N = at_count.interval_high_N;
    for (const auto& [sensors, c] : best)
        record.counts.push_back(count_record(candidates[c], question.scores[c]));
    record.alternatives = indifferent_set(candidates, question.scores, chosen);
    record.sentence = recommendation_sentence(study, record, policy.worthwhile_gain_N);
    return record;
}

// Shares of a regime's own scenarios, equal and summing to one; zero elsewhere.
std::vector<double> scenario_shares(const storage::StudyDescription& study, const std::string& regime) {
    std::vector<double> share;
    double total = 0.0;
    for (const storage::ScenarioRecord& scenario : study.scenarios) {
        share.push_back(scenario.regime == regime ? 1.0 : 0.0);
        total += share.back();
    }
    for (double& s : share) s /= total;
    return share;
}

}  // namespace

std::vector<storage::RecommendationRecord> recommend(storage::Database& database, std::int64_t study_id,
                                                     const RecommendationPolicy& policy) {
    const storage::StudyDescription study = storage::load_study(database, study_id);
    std::vector<std::vector<double>> regime_share;
    std::vector<double> duty_share(study.scenarios.size(), 0.0);
    for (const storage::RegimeRecord& regime : study.regimes) {
        regime_share.push_back(scenario_shares(study, regime.regime));
        for (std::size_t s = 0; s < duty_share.size(); ++s) {
            duty_share[s] += regime.duty_share * regime_share.back()[s];
        }
    }
    std::vector<storage::RecommendationRecord> recommendations;
    for (int noise = 0; noise < static_cast<int>(study.noise_levels.size()); ++noise) {
        const auto candidates =
            placement_candidates(study, storage::read_cell_summaries(database, study_id, noise));
        if (candidates.empty()) continue;  // only methods that are told the direction
        const auto ask = [&](const Question& question) {
            recommendations.push_back(answer(study, noise, candidates, question, policy));
        };
        for (std::size_t r = 0; r < study.regimes.size(); ++r) {
            ask({"regime", study.regimes[r].regime, weighted_scores(candidates, regime_share[r])});
        }
        ask({"minimax_regret", "", regret_scores(candidates, regime_share)});
        ask({"duty_cycle", "", weighted_scores(candidates, duty_share)});
    }
    return recommendations;
}

}  // namespace capstan
