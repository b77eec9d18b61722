#include "capstan/placement/placement_questions.h"

namespace capstan {

namespace {

// Equal shares of a regime's own scenarios; zero elsewhere.
std::vector<double> shares_of(const storage::StudyDescription& study, const std::string& regime) {
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

ScenarioShares scenario_shares(const storage::StudyDescription& study) {
    ScenarioShares shares{{}, std::vector<double>(study.scenarios.size(), 0.0)};
    for (const storage::RegimeRecord& regime : study.regimes) {
        shares.regime.push_back(shares_of(study, regime.regime));
        for (std::size_t s = 0; s < shares.duty.size(); ++s) {
            shares.duty[s] += regime.duty_share * shares.regime.back()[s];
        }
    }
    return shares;
}

std::vector<PlacementQuestion> placement_questions(const std::vector<PlacementCandidate>& candidates,
                                                   const storage::StudyDescription& study,
                                                   const ScenarioShares& shares,
                                                   const std::vector<int>& reference) {
    std::vector<PlacementQuestion> questions;
    for (std::size_t r = 0; r < study.regimes.size(); ++r) {
        questions.push_back(
            {"regime", study.regimes[r].regime, weighted_scores(candidates, shares.regime[r])});
    }
    questions.push_back({"minimax_regret", "", regret_scores(candidates, shares.regime, reference)});
    questions.push_back({"duty_cycle", "", weighted_scores(candidates, shares.duty)});
    return questions;
}

}  // namespace capstan
