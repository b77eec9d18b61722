#include "capstan/placement/placement_questions.h"

namespace capstan {

namespace {

// Equal fraction of a regime's own scenarios; zero elsewhere.
std::vector<double> fractions_of(const storage::StudyDescription& study, const std::string& regime) {
    std::vector<double> fraction;
    double total = 0.0;
    for (const storage::ScenarioRecord& scenario : study.scenarios) {
        fraction.push_back(scenario.regime == regime ? 1.0 : 0.0);
        total += fraction.back();
    }
    for (double& s : fraction) s /= total;
    return fraction;
}

}  // namespace

ScenarioShares scenario_fractions(const storage::StudyDescription& study) {
    ScenarioShares fractions{{}, std::vector<double>(study.scenarios.size(), 0.0)};
    for (const storage::RegimeRecord& regime : study.regimes) {
        fractions.regime.push_back(fractions_of(study, regime.regime));
        for (std::size_t s = 0; s < fractions.duty.size(); ++s) {
            fractions.duty[s] += regime.duty_fraction * fractions.regime.back()[s];
        }
    }
    return fractions;
}

std::vector<PlacementQuestion> placement_questions(const std::vector<PlacementCandidate>& candidates,
                                                   const storage::StudyDescription& study,
                                                   const ScenarioShares& fractions,
                                                   const std::vector<int>& reference) {
    std::vector<PlacementQuestion> questions;
    for (std::size_t r = 0; r < study.regimes.size(); ++r) {
        questions.push_back(
            {"regime", study.regimes[r].regime, weighted_scores(candidates, fractions.regime[r])});
    }
    questions.push_back({"minimax_regret", "", regret_scores(candidates, fractions.regime, reference)});
    questions.push_back({"duty_cycle", "", weighted_scores(candidates, fractions.duty)});
    return questions;
}

}  // namespace capstan
