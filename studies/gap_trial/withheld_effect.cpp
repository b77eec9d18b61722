#include "capstan/gap_trial/withheld_effect.h"

#include <algorithm>

namespace capstan::gap_trial {

bool fits(const EffectMaker& maker, const TrialBench& bench, const std::vector<TrialRun>& runs) {
    if (maker.needs_pair && !bench.is_pair()) return false;
    if (!maker.needs_motion) return true;
    return std::any_of(runs.begin(), runs.end(),
                       [](const TrialRun& run) { return run.output == OutputKind::handle; });
}

std::string effect_family(const std::string& effect) {
    static const std::map<std::string, std::string> families = {
        {"viscous_friction", "friction law"},
        {"stribeck", "friction law"},
        {"presliding", "friction law"},
        {"load_dependent_friction", "friction law"},
        {"bending_stiffness", "friction law"},
        {"local_bend", "friction place"},
        {"moving_bend", "friction place"},
        {"param_mu", "friction place"},
        {"pulley_friction", "end friction"},
        {"motor_cogging", "actuator"},
        {"inertia", "actuator"},
        {"backlash", "lost motion"},
        {"conduit_compliance", "compliance"},
        {"cable_stiffness_nonlinear", "compliance"},
        {"creep", "compliance"},
        {"environment_coupling", "compliance"},
        {"param_K", "compliance"},
        {"pretension_drift", "pretension"},
        {"param_T0", "pretension"},
        {"sensor_gain", "sensor"},
        {"sensor_offset", "sensor"},
        {"sensor_lag", "sensor"},
        {"time_misalignment", "sensor"},
        {"sensor_quantization", "sensor"},
        {"sensor_hysteresis", "sensor"},
    };
    const auto found = families.find(effect);
    return found == families.end() ? effect : found->second;
}

}  // namespace capstan::gap_trial
