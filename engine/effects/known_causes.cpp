#include "capstan/effects/known_causes.h"

#include <algorithm>

#include "capstan/effects/effect_catalogue.h"
#include "capstan/effects/sensor_faults.h"

namespace capstan {

const std::vector<KnownCause>& known_causes() {
    static const std::vector<KnownCause> all = [] {
        std::vector<KnownCause> causes = {
            {.name = "param_mu", .title = "wrong friction coefficient", .family = "friction place"},
            {.name = "param_K", .title = "wrong cable stiffness", .family = "compliance"},
            {.name = "param_T0", .title = "wrong pretension", .family = "pretension"},
        };
        for (const Effect& effect : effect_catalogue()) {
            if (causes.back().name != effect.name)
                causes.push_back(
                    {effect.name, effect.title, effect.family, effect.confusable_with, effect.answered_as});
        }
        for (const SensorFault& fault : sensor_fault_catalogue()) {
            if (fault.variant.empty())
                causes.push_back(
                    {fault.name, fault.title, "sensor", fault.confusable_with, fault.answered_as});
        }
        return causes;
    }();
    return all;
}

const KnownCause* find_cause(std::string_view name) {
    for (const KnownCause& cause : known_causes()) {
        if (cause.name == name) return &cause;
    }
    return nullptr;
}

std::string cause_title(std::string_view name) {
    const KnownCause* cause = find_cause(name);
    return cause != nullptr ? cause->title : std::string(name);
}

std::string answered_name(const std::string& name) {
    const KnownCause* cause = find_cause(name);
    return cause != nullptr && !cause->answered_as.empty() ? cause->answered_as : name;
}

std::vector<std::string> confusable_causes(std::string_view name) {
    const KnownCause* cause = find_cause(name);
    std::vector<std::string> names = cause != nullptr ? cause->confusable_with : std::vector<std::string>();
    for (const KnownCause& other : known_causes()) {
        const auto& stated = other.confusable_with;
        if (std::find(stated.begin(), stated.end(), name) != stated.end()) names.push_back(other.name);
    }
    return names;
}

}  // namespace capstan
