#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

StudyKey uncertain(std::string name, const std::string& what, std::vector<double> SensitivityPlan::*range) {
    return number_list<StudyPlan>(
        {"sensitivity", std::move(name), "",
         "The smallest and the largest factor on " + what + "; [1, 1] means no uncertainty."},
        above_zero,
        SensitivityPlan{}.*range, [range](auto& plan, int) -> auto& { return plan.sensitivity.*range; });
}

}  // namespace

void add_sensitivity_keys(std::vector<ConfigKey<StudyPlan>>& keys) {
    const std::string at = "sensitivity";
    const SensitivityPlan standard;
    const KeyCondition<StudyPlan> with_instants{
        [](const StudyPlan& plan, int) { return !plan.uncertainty.is_stated; }, "no [uncertainty]"};
    const auto add = [&](StudyKey key, const KeyCondition<StudyPlan>& condition) {
        key.condition = condition;
        keys.push_back(std::move(key));
    };
    keys.push_back(
        uncertain("friction_ratio", "both friction coefficients", &SensitivityPlan::friction_ratio));
    keys.push_back(uncertain("curvature_ratio", "the curvature of every bend (its radius is divided)",
                             &SensitivityPlan::curvature_ratio));
    keys.push_back(
        uncertain("stiffness_ratio", "the cable's axial stiffness", &SensitivityPlan::stiffness_ratio));
    keys.push_back(uncertain("pretension_ratio", "the pretension", &SensitivityPlan::pretension_ratio));
    keys.push_back(uncertain("noise_ratio", "the sensors' noise and bias", &SensitivityPlan::noise_ratio));
    add(uncertain("uncertainty_ratio", "each fraction of [uncertainty]", &SensitivityPlan::uncertainty_ratio),
        with_worlds);
    add(uncertain("far_end_range_ratio", "the range of the far end's motion",
                  &SensitivityPlan::far_end_range_ratio),
        with_worlds);
    add(uncertain("far_end_bandwidth_ratio", "the bandwidth of the far end's motion",
                  &SensitivityPlan::far_end_bandwidth_ratio),
        with_worlds);
    add(integer(
            {at, "values", "", "Values tried in each range, spread evenly on a logarithmic scale."},
            {1, true, 50}, std::int64_t{standard.values},
            [](auto& plan, int) -> auto& { return plan.sensitivity.values; }),
        with_worlds);
    add(integer(
            {at, "sensors", "", "The number of sensors that the advice is for."}, {1, true, 64},
            std::int64_t{standard.sensors},
            [](auto& plan, int) -> auto& { return plan.sensitivity.sensors; }),
        with_instants);
    add(string(
            {at, "method", "",
             "The fusion method that the advice is for; \"any\": the best method of each layout."},
            standard.method, [](auto& plan, int) -> auto& { return plan.sensitivity.method; }),
        with_instants);
    add(string(
            {at, "regime", "", "The regime that the advice is for, or \"duty_cycle\"."}, standard.regime,
            [](auto& plan, int) -> auto& { return plan.sensitivity.regime; }),
        with_instants);
    add(number(
            {at, "tolerance_N", "N",
             "The advice counts as changed where another layout is better by more than this."},
            above_zero, standard.tolerance_N,
            [](auto& plan, int) -> auto& { return plan.sensitivity.tolerance_N; }),
        with_instants);
    keys.push_back(integer(
        {at, "repetitions", "",
         "Noise draws, or worlds, for each set of parameters, at most those of the study; the choice is "
         "evaluated on as many independent ones."},
        {40, true, 1e6}, std::int64_t{standard.repetitions},
        [](auto& plan, int) -> auto& { return plan.sensitivity.repetitions; }));
    add(integer(
            {at, "trajectories", "",
             "Number of paths of the Morris screening; each path needs one more set of parameters than "
             "there are parameters."},
            {2, true, 10000}, std::int64_t{standard.trajectories},
            [](auto& plan, int) -> auto& { return plan.sensitivity.trajectories; }),
        with_instants);
}

}  // namespace capstan::config
