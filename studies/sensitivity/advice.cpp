#include "capstan/sensitivity/advice.h"

#include <algorithm>
#include <cstdio>

#include "capstan/cable/invalid_input.h"
#include "capstan/plan/placement_constraints.h"
#include "capstan/search/scored_draws.h"
#include "capstan/sensitivity/uncertain_parameter.h"

namespace capstan::sensitivity {

namespace {

// Layouts times nodes; above this a hundred sets of parameters take many minutes.
constexpr double max_scored_nodes = 1.0e5;

std::vector<const FusionMethod*> methods_of(const PreparedStudy& study) {
    std::vector<const FusionMethod*> methods;
    for (const FusionMethod* method : study.methods) {
        const bool is_wanted =
            study.plan.sensitivity.method == "any" || study.plan.sensitivity.method == method->name;
        if (is_wanted && method->knowledge != Knowledge::direction_known) methods.push_back(method);
    }
    return methods;
}

// Equal fraction of each regime's instants.
std::vector<double> fractions_of(const PreparedStudy& study) {
    const std::string& wanted = study.plan.sensitivity.regime;
    std::vector<double> fraction;
    for (const PreparedScenario& scenario : study.scenarios) {
        const auto regime =
            std::find_if(study.plan.regimes.begin(), study.plan.regimes.end(),
                         [&](const RegimeInstants& each) { return each.regime == scenario.regime; });
        const double of_regime =
            wanted == "duty_cycle" ? regime->duty_fraction : (name_of(regime->regime) == wanted ? 1.0 : 0.0);
        fraction.push_back(of_regime / static_cast<double>(regime->samples.size()));
    }
    return fraction;
}

bool has_regime(const StudyPlan& plan) {
    return plan.sensitivity.regime == "duty_cycle" ||
           std::any_of(plan.regimes.begin(), plan.regimes.end(), [&](const RegimeInstants& each) {
               return name_of(each.regime) == plan.sensitivity.regime;
           });
}

int candidate_of(const CandidateList& candidates, const Advice& advice) {
    for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
        if (candidates.methods[m]->name == advice.method)
            return candidates.of(candidates.subsets.find(advice.nodes), static_cast<int>(m));
    }
    return -1;
}

Advice advice_of(const CandidateList& candidates, int candidate) {
    return {candidates.subsets.nodes_of(candidates.subset(candidate)),
            std::string(candidates.methods[candidates.method(candidate)]->name)};
}

std::vector<KeyProblem> problems_of_question(const StudyPlan& plan) {
    std::vector<KeyProblem> problems = problems_of(plan.sensitivity, plan.transmission.cable.segments + 1);
    const SensitivityPlan& question = plan.sensitivity;
    const FusionMethod* method = find_fusion_method(question.method);
    const bool named = std::find(plan.fusion_methods.begin(), plan.fusion_methods.end(), question.method) !=
                       plan.fusion_methods.end();
    if (question.method != "any" && (!named || method->knowledge == Knowledge::direction_known)) {
        problems.push_back(
            {"sensitivity.method",
             "\"" + question.method +
                 "\" is not one of estimation.methods that work without the true direction; name "
                 "one of them, or \"any\""});
    }
    if (!has_regime(plan)) {
        problems.push_back({"sensitivity.regime", "no [[regime]] is named \"" + question.regime +
                                                      "\"; name one that is, or \"duty_cycle\""});
    }
    const int nodes = static_cast<int>(
        PlacementConstraints(plan.placement, plan.transmission.cable.segments + 1).usable_nodes().size());
    if (nodes > 63 || SensorSubsets::how_many(nodes, question.sensors) * nodes > max_scored_nodes) {
        problems.push_back(
            {"sensitivity.sensors",
             "so many nodes have too many layouts of " + std::to_string(question.sensors) +
                 " sensors to score under many sets of parameters; ask about fewer sensors, or "
                 "forbid nodes in placement.forbidden_nodes"});
    }
    return problems;
}

}  // namespace

AdviceQuestion::AdviceQuestion(const StudyPlan& plan, int noise_index)
    : plan_(plan), noise_index_(noise_index) {
    std::vector<KeyProblem> problems = problems_of(plan);
    if (problems.empty()) problems = problems_of_question(plan);
    if (!problems.empty()) throw InvalidInput(problems);
}

std::optional<AdviceThere> AdviceQuestion::ask(const std::vector<double>& ratio, const Advice* given) const {
    std::optional<StudyPlan> plan = plan_with(plan_, noise_index_, ratio);
    if (!plan || !has_regime(*plan)) return std::nullopt;
    plan->repetitions = plan_.sensitivity.repetitions;
    const bool has_mass = std::any_of(plan->regimes.begin(), plan->regimes.end(),
                                      [](const auto& each) { return each.regime == Regime::mass; });
    if (!has_mass) plan->weight_source = WeightSource::same_regime;
    const PreparedStudy study = prepare(*plan);
    const PlacementConstraints constraints(plan->placement, study.nodes());
    const int sensors = plan->sensitivity.sensors;
    const SensorSubsets subsets(constraints.usable_nodes(), sensors);
    CandidateList candidates{subsets, methods_of(study), {}};
    candidates.wanted.assign(candidates.count(), 0);
    std::vector<int> allowed;
    for (int s = 1; s < subsets.count(); ++s) {
        if (subsets.sensors(s) != sensors || !constraints.allow(subsets.nodes_of(s))) continue;
        for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
            allowed.push_back(candidates.of(s, static_cast<int>(m)));
            candidates.wanted[allowed.back()] = 1;
        }
    }
    if (allowed.empty()) {
        throw InvalidInput({"sensitivity.sensors: no layout of " + std::to_string(sensors) +
                            " sensors satisfies the constraints in [placement]; ask about another number"});
    }
    const PlacementScope scope("regime", "", fractions_of(study));
    const auto weights = ScoredDraws::weights(study, noise_index_, 1);
    const DrawBlocks blocks = DrawBlocks::for_repetitions(plan->repetitions);
    const PlacementObjective objective = plan->placement.objective;
    ScoredDraws searched(study, noise_index_, 0, candidates, objective);
    searched.extend(blocks, weights, 1);
    int best = allowed.front();
    double best_N = scope.objective_N(searched.scenarios(), best);
    for (const int candidate : allowed) {
        const double error_N = scope.objective_N(searched.scenarios(), candidate);
        if (error_N >= best_N) continue;
        best = candidate;
        best_N = error_N;
    }
    const int other = given == nullptr ? best : candidate_of(candidates, *given);
    std::fill(candidates.wanted.begin(), candidates.wanted.end(), 0);
    candidates.wanted[best] = candidates.wanted[other] = 1;
    ScoredDraws independent(study, noise_index_, independent_draws, candidates, objective);
    independent.extend(blocks, weights, 1);
    const Score best_score = scope.score(independent.scenarios(), best);
    const Score other_score = scope.score(independent.scenarios(), other);
    return AdviceThere{advice_of(candidates, best), interval_of(best_score),
                       interval_of(difference_of(other_score, best_score))};
}

}  // namespace capstan::sensitivity
