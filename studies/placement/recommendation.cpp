#include "capstan/placement/recommendation.h"

#include <algorithm>
#include <map>

#include "capstan/placement/candidate_scores.h"
#include "capstan/placement/intervals.h"
#include "capstan/placement/placement_questions.h"
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

std::vector<CountError> count_errors(const std::map<int, int>& best, const std::vector<Score>& scores) {
    std::vector<CountError> by_count;
    for (const auto& [sensors, c] : best) by_count.push_back({sensors, scores[c].objective_N});
    return by_count;
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
        const SimultaneousIntervals intervals(scores[c].block_objective_N.size(), choices[sensors], 0.05);
        const IntervalEstimate error = intervals.of(scores[c]);
        records.push_back({sensors, candidates[c].set_index, candidates[c].method, error.value_N, error.low_N,
                           error.high_N});
    }
    return records;
}

// The candidates with the recommended count that paired t tests at the 5% level, Bonferroni-corrected over
// all of them, do not find worse than the recommended one.
std::vector<storage::RecommendationAlternativeRecord> indifferent_set(
    const std::vector<PlacementCandidate>& candidates, const std::vector<Score>& scores, int recommended) {
    std::vector<int> others;
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c) {
        if (c != recommended && candidates[c].sensor_count == candidates[recommended].sensor_count) {
            others.push_back(c);
        }
    }
    std::vector<storage::RecommendationAlternativeRecord> alternatives;
    for (const auto& [c, difference] : simultaneous_differences(scores, recommended, others)) {
        if (difference.low_N > 0.0) continue;
        alternatives.push_back({candidates[c].set_index, candidates[c].method, difference.value_N,
                                difference.low_N, difference.high_N});
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
    const int count =
        count_where_gain_flattens(count_errors(best, question.scores), policy.worthwhile_gain_N);
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

// The largest excess without any sensor over the best candidate of each regime, on independent draws.
RecommendationPolicy with_excess_of_none(RecommendationPolicy policy,
                                         const std::vector<PlacementQuestion>& judged,
                                         const std::vector<storage::RegimeRecord>& regimes,
                                         const std::vector<int>& reference) {
    if (policy.no_sensor_N.empty()) return policy;
    double excess_N = 0.0;
    for (std::size_t r = 0; r < regimes.size(); ++r)
        excess_N = std::max(
            excess_N, policy.no_sensor_N.at(regimes[r].regime) - judged[r].scores[reference[r]].objective_N);
    policy.no_sensor_N["minimax_regret"] = excess_N;
    return policy;
}

}  // namespace

std::optional<double> no_sensor_error_N(const std::map<std::string, double>& no_sensor_N,
                                        const storage::RecommendationRecord& recommendation) {
    const auto found =
        no_sensor_N.find(recommendation.scope == "regime" ? recommendation.regime : recommendation.scope);
    return found == no_sensor_N.end() ? std::nullopt : std::optional(found->second);
}

bool beats_no_sensor(const storage::RecommendationRecord& recommendation, double no_sensor_N) {
    return recommendation.interval_high_N < no_sensor_N;
}

double searched_error_N(const storage::RecommendationRecord& recommendation) {
    for (const storage::RecommendationCountRecord& count : recommendation.counts) {
        if (count.sensor_count == recommendation.sensor_count) return count.error_N;
    }
    return recommendation.error_N;
}

std::vector<storage::RecommendationRecord> recommend(storage::Database& database, std::int64_t study_id,
                                                     const RecommendationPolicy& policy,
                                                     const IndependentErrors& independent_errors) {
    const storage::StudyDescription study = storage::load_study(database, study_id);
    const ScenarioFractions fractions = scenario_fractions(study);
    std::vector<storage::RecommendationRecord> recommendations;
    for (int noise = 0; noise < static_cast<int>(study.noise_levels.size()); ++noise) {
        const auto candidates =
            placement_candidates(study, storage::read_cell_summaries(database, study_id, noise));
        if (candidates.empty()) continue;  // only methods that are told the direction
        const std::vector<int> reference = best_of_regimes(candidates, fractions.regime);
        std::vector<Choice> choices;
        for (const PlacementQuestion& question : placement_questions(candidates, study, fractions, reference))
            choices.push_back(choose(noise, candidates, question, policy));

        // To be scored on independent draws: the choices in the order of the questions, then the
        // candidates from which regrets are measured.
        std::vector<PlacementCandidate> chosen;
        for (const Choice& choice : choices) chosen.push_back(candidates[choice.candidate]);
        std::vector<int> chosen_reference;
        for (const int each : reference) {
            chosen_reference.push_back(static_cast<int>(chosen.size()));
            chosen.push_back(candidates[each]);
        }
        const auto judged =
            placement_questions(independent_errors(noise, chosen), study, fractions, chosen_reference);
        const RecommendationPolicy full_policy =
            with_excess_of_none(policy, judged, study.regimes, chosen_reference);
        for (std::size_t q = 0; q < choices.size(); ++q) {
            storage::RecommendationRecord& record = choices[q].record;
            const IntervalEstimate error = interval_of(judged[q].scores[q]);
            record.error_N = error.value_N;
            record.interval_low_N = error.low_N;
            record.interval_high_N = error.high_N;
            record.sentence = recommendation_sentence(study, record, full_policy);
            recommendations.push_back(std::move(record));
        }
    }
    return recommendations;
}

}  // namespace capstan
