#include "capstan/placement/placement_questions.h"

#include <algorithm>

namespace capstan {

namespace {

// Equal fraction of a regime's own scenarios; zero elsewhere.
std::vector<double> fractions_of(const std::string& regime, const std::vector<std::string>& scenario_regime) {
    std::vector<double> fraction;
    double total = 0.0;
    for (const std::string& own : scenario_regime) {
        fraction.push_back(own == regime ? 1.0 : 0.0);
        total += fraction.back();
    }
    for (double& s : fraction) s /= total;
    return fraction;
}

void add_regime(ScenarioFractions& fractions, const std::string& regime, double duty_fraction,
                const std::vector<std::string>& scenario_regime) {
    fractions.duty.resize(scenario_regime.size(), 0.0);
    fractions.regime.push_back(fractions_of(regime, scenario_regime));
    for (std::size_t s = 0; s < fractions.duty.size(); ++s) {
        fractions.duty[s] += duty_fraction * fractions.regime.back()[s];
    }
}

}  // namespace

ScenarioFractions scenario_fractions(const storage::StudyDescription& study) {
    std::vector<std::string> scenario_regime;
    for (const auto& scenario : study.scenarios) scenario_regime.push_back(scenario.regime);
    ScenarioFractions fractions;
    for (const auto& each : study.regimes) {
        add_regime(fractions, each.regime, each.duty_fraction, scenario_regime);
    }
    return fractions;
}

ScenarioFractions scenario_fractions(const PreparedStudy& study) {
    std::vector<std::string> scenario_regime;
    for (const auto& scenario : study.scenarios) scenario_regime.emplace_back(name_of(scenario.regime));
    ScenarioFractions fractions;
    for (const auto& each : study.plan.regimes) {
        add_regime(fractions, std::string(name_of(each.regime)), each.duty_fraction, scenario_regime);
    }
    return fractions;
}

std::vector<PlacementQuestion> placement_questions(const std::vector<PlacementCandidate>& candidates,
                                                   const storage::StudyDescription& study,
                                                   const ScenarioFractions& fractions,
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

int count_where_gain_flattens(std::span<const CountError> by_count, double worthwhile_gain_N) {
    for (const CountError& here : by_count) {
        const bool flat = std::all_of(by_count.begin(), by_count.end(), [&](const CountError& more) {
            const double gain_N = here.error_N - more.error_N;
            return more.sensors <= here.sensors ||
                   gain_N <= worthwhile_gain_N * (more.sensors - here.sensors);
        });
        if (flat) return here.sensors;
    }
    return by_count.empty() ? 0 : by_count.back().sensors;
}

}  // namespace capstan
