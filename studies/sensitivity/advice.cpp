#include "capstan/sensitivity/advice.h"

#include <algorithm>
#include <cstdio>

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/repetition_blocks.h"
#include "capstan/placement/scored_draws.h"
#include "capstan/plan/placement_constraints.h"
#include "capstan/sensitivity/uncertain_parameter.h"

namespace capstan::sensitivity {

namespace {

// Layouts times nodes; more take many minutes under a hundred sets of parameters.
constexpr double max_scored_nodes = 1.0e5;

EqualBlocks blocks_of(int repetitions) {
    const RepetitionBlocks blocks{repetitions};
    return {blocks.count(), blocks.block_size()};  // rounds up to whole blocks
}

std::vector<const FusionMethod*> methods_of(const PreparedStudy& study) {
    std::vector<const FusionMethod*> methods;
    for (const FusionMethod* method : study.methods) {
        const bool is_asked =
            study.plan.sensitivity.method == "any" || study.plan.sensitivity.method == method->name;
        if (is_asked && method->knowledge != Knowledge::direction_known) methods.push_back(method);
    }
    return methods;
}

// Equal fraction of each regime's instants.
std::vector<double> fractions_of(const PreparedStudy& study) {
    const std::string& asked = study.plan.sensitivity.regime;
    std::vector<double> fraction;
    for (const PreparedScenario& scenario : study.scenarios) {
        const auto regime =
            std::find_if(study.plan.regimes.begin(), study.plan.regimes.end(),
                         [&](const RegimeInstants& each) { return each.regime == scenario.regime; });
        const double of_regime =
            asked == "duty_cycle" ? regime->duty_fraction : (name_of(regime->regime) == asked ? 1.0 : 0.0);
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
    const SensitivityPlan& asked = plan.sensitivity;
    const FusionMethod* method = find_fusion_method(asked.method);
    const bool named = std::find(plan.fusion_methods.begin(), plan.fusion_methods.end(), asked.method) !=
                       plan.fusion_methods.end();
    if (asked.method != "any" && (!named || method->knowledge == Knowledge::direction_known)) {
        problems.push_back(
            {"sensitivity.method",
             "\"" + asked.method +
                 "\" is not one of estimation.methods that need not be told the direction; name "
                 "one of them, or \"any\""});
    }
    if (!has_regime(plan)) {
        problems.push_back({"sensitivity.regime", "no [[regime]] is named \"" + asked.regime +
                                                      "\"; name one that is, or \"duty_cycle\""});
    }
    const int nodes = static_cast<int>(
        PlacementConstraints(plan.placement, plan.transmission.cable.segments + 1).usable_nodes().size());
    if (nodes > 63 || SensorSubsets::how_many(nodes, asked.sensors) * nodes > max_scored_nodes) {
        problems.push_back(
            {"sensitivity.sensors",
             "so many nodes have too many layouts of " + std::to_string(asked.sensors) +
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
    const EqualBlocks blocks = blocks_of(plan->repetitions);
    const PlacementObjective objective = plan->placement.objective;
    ScoredDraws searched(study, noise_index_, 0, candidates, objective);
    searched.extend(blocks.count, blocks.size, weights, 1);
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
    ScoredDraws fresh(study, noise_index_, fresh_draws, candidates, objective);
    fresh.extend(blocks.count, blocks.size, weights, 1);
    const std::vector<double> of_best_N = scope.block_objective_N(fresh.scenarios(), best);
    std::vector<double> apart_N = scope.block_objective_N(fresh.scenarios(), other);
    for (std::size_t b = 0; b < apart_N.size(); ++b) apart_N[b] -= of_best_N[b];
    const double error_N = scope.objective_N(fresh.scenarios(), best);
    return AdviceThere{advice_of(candidates, best), interval_of(error_N, of_best_N),
                       interval_of(scope.objective_N(fresh.scenarios(), other) - error_N, apart_N)};
}

}  // namespace capstan::sensitivity
