#include "capstan/placement/recommendation.h"

#include <algorithm>
#include <map>

#include "capstan/placement/candidate_scores.h"
#include "capstan/placement/paired_comparison.h"
#include "capstan/placement/placement_questions.h"
#include "capstan/placement/placement_scope.h"
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

// The best of each count, judged on the draws that made it the best: the interval holds for all choices of
// the count together, so it holds for whichever of them looks best.
std::vector<storage::RecommendationCountRecord> count_records(
    const std::vector<PlacementCandidate>& candidates, const std::vector<Score>& scores,
    const std::map<int, int>& best) {
    std::map<int, int> choices;  // by count
    for (const PlacementCandidate& candidate : candidates) ++choices[candidate.sensor_count];
    std::vector<storage::RecommendationCountRecord> records;
    for (const auto& [sensors, c] : best) {
        const double error_N = scores[c].objective_N;
        const double reach_N = simultaneous_reach_N(scores[c].block_objective_N, choices[sensors]);
        records.push_back({sensors, candidates[c].set_index, candidates[c].method, error_N, error_N - reach_N,
                           error_N + reach_N});
    }
    return records;
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

// A question's answer on the study's own draws.
struct Choice {
    int candidate = 0;
    storage::RecommendationRecord record;
};

Choice choose(int noise_index, const std::vector<PlacementCandidate>& candidates,
              const PlacementQuestion& question, const RecommendationPolicy& policy) {
    const std::map<int, int> best = best_by_count(candidates, question.scores);
    const int count = count_where_gain_flattens(best, question.scores, policy.worthwhile_gain_N);
    Choice choice{best.at(count), {}};
    storage::RecommendationRecord& record = choice.record;
    record.noise_index = noise_index;
    record.scope = question.scope;
    record.regime = question.regime;
    record.set_index = candidates[choice.candidate].set_index;
    record.method = candidates[choice.candidate].method;
    record.sensor_count = count;
    record.counts = count_records(candidates, question.scores, best);
    record.alternatives = indifferent_set(candidates, question.scores, choice.candidate);
    return choice;
}

}  // namespace

double searched_error_N(const storage::RecommendationRecord& recommendation) {
    for (const storage::RecommendationCountRecord& count : recommendation.counts) {
        if (count.sensor_count == recommendation.sensor_count) return count.error_N;
    }
    return recommendation.error_N;
}

std::vector<storage::RecommendationRecord> recommend(storage::Database& database, std::int64_t study_id,
                                                     const RecommendationPolicy& policy,
                                                     const FreshErrors& fresh_errors) {
    const storage::StudyDescription study = storage::load_study(database, study_id);
    const ScenarioShares fractions = scenario_fractions(study);
    std::vector<storage::RecommendationRecord> recommendations;
    for (int noise = 0; noise < static_cast<int>(study.noise_levels.size()); ++noise) {
        const auto candidates =
            placement_candidates(study, storage::read_cell_summaries(database, study_id, noise));
        if (candidates.empty()) continue;  // only methods that are told the direction
        const std::vector<int> reference = best_of_regimes(candidates, fractions.regime);
        std::vector<Choice> choices;
        for (const PlacementQuestion& question : placement_questions(candidates, study, fractions, reference))
            choices.push_back(choose(noise, candidates, question, policy));

        // On fresh draws: what was chosen, in the order of the questions, then what regrets are measured
        // from.
        std::vector<PlacementCandidate> chosen;
        for (const Choice& choice : choices) chosen.push_back(candidates[choice.candidate]);
        std::vector<int> chosen_reference;
        for (const int each : reference) {
            chosen_reference.push_back(static_cast<int>(chosen.size()));
            chosen.push_back(candidates[each]);
        }
        const auto asked_afresh =
            placement_questions(fresh_errors(noise, chosen), study, fractions, chosen_reference);
        for (std::size_t q = 0; q < choices.size(); ++q) {
            storage::RecommendationRecord& record = choices[q].record;
            const Score& score = asked_afresh[q].scores[q];
            const IntervalEstimate error = interval_of(score.objective_N, score.block_objective_N);
            record.error_N = error.value_N;
            record.interval_low_N = error.low_N;
            record.interval_high_N = error.high_N;
            record.sentence = recommendation_sentence(study, record, policy.worthwhile_gain_N);
            recommendations.push_back(std::move(record));
        }
    }
    return recommendations;
}

}  // namespace capstan
