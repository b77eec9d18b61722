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
    keys.push_back(
        uncertain("friction_ratio", "both friction coefficients", &SensitivityPlan::friction_ratio));
    keys.push_back(uncertain("curvature_ratio", "the curvature of every bend (its radius is divided)",
                             &SensitivityPlan::curvature_ratio));
    keys.push_back(
        uncertain("stiffness_ratio", "the cable's axial stiffness", &SensitivityPlan::stiffness_ratio));
    keys.push_back(uncertain("pretension_ratio", "the pretension", &SensitivityPlan::pretension_ratio));
    keys.push_back(uncertain("noise_ratio", "the sensors' noise and bias", &SensitivityPlan::noise_ratio));
    keys.push_back(integer(
        {at, "sensors", "", "The number of sensors that the advice is for."}, {1, true, 64},
        std::int64_t{standard.sensors}, [](auto& plan, int) -> auto& { return plan.sensitivity.sensors; }));
    keys.push_back(string(
        {at, "method", "",
         "The fusion method that the advice is for; \"any\": the best method of each layout."},
        standard.method, [](auto& plan, int) -> auto& { return plan.sensitivity.method; }));
    keys.push_back(string(
        {at, "regime", "", "The regime that the advice is for, or \"duty_cycle\"."}, standard.regime,
        [](auto& plan, int) -> auto& { return plan.sensitivity.regime; }));
    keys.push_back(number(
        {at, "tolerance_N", "N",
         "The advice counts as changed where another layout is better by more than this."},
        above_zero, standard.tolerance_N,
        [](auto& plan, int) -> auto& { return plan.sensitivity.tolerance_N; }));
    keys.push_back(integer(
        {at, "repetitions", "",
         "Noise draws for each set of parameters; the choice is evaluated on as many independent "
         "draws."},
        {40, true, 1e6}, std::int64_t{standard.repetitions},
        [](auto& plan, int) -> auto& { return plan.sensitivity.repetitions; }));
    keys.push_back(integer(
        {at, "trajectories", "",
         "Number of paths of the Morris screening; each path needs one more set of parameters than "
         "there are parameters."},
        {2, true, 10000}, std::int64_t{standard.trajectories},
        [](auto& plan, int) -> auto& { return plan.sensitivity.trajectories; }));
}

}  // namespace capstan::config
