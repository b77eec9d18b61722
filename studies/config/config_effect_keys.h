#pragma once
// Keys of the engine's effects, for every kind of plan that can have them.

#include <string>
#include <vector>

#include "capstan/config/config_key_makers.h"
#include "capstan/effects/effect_catalogue.h"

namespace capstan::config {

/// "local_bend", "cable A" -> "local_bend_cable_A"; "N m s/rad" -> "Nm_s_per_rad".
std::string in_key_letters(std::string text);

/// "effect", local_bend -> "effect.local_bend_cable_A".
std::string effect_section(const std::string& root, const Effect& effect);
/// The key of a parameter, its unit at its end.
std::string effect_key_name(const EffectParameter& parameter);

template <class Plan, class Takes>
void add_effect_sections(std::vector<ConfigSection<Plan>>& sections, const std::string& root, Takes takes) {
    for (const Effect& effect : effect_catalogue()) {
        if (takes(effect))
            sections.push_back(
                {effect_section(root, effect), effect.meaning + " (" + effect.equation + ")."});
    }
}

/// `field(plan)`: its EffectValues.
template <class Plan, class Takes, class Field>
void add_effect_keys(std::vector<ConfigKey<Plan>>& keys, const std::string& root, Takes takes, Field field) {
    for (std::size_t e = 0; e < effect_catalogue().size(); ++e) {
        const Effect& effect = effect_catalogue()[e];
        if (!takes(effect)) continue;
        for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
            const EffectParameter& parameter = effect.parameters[p];
            keys.push_back(number<Plan>(
                {effect_section(root, effect), effect_key_name(parameter), parameter.unit,
                 "Typical of a mild case: " + std::to_string(parameter.typical).substr(0, 7) + "."},
                {parameter.low, true, parameter.high}, effect.absent[p],
                [ e, p, field ](auto& plan, int) -> auto& { return field(plan)[e][p]; }));
        }
    }
}

}  // namespace capstan::config
