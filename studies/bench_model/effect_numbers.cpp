#include "capstan/bench_model/effect_numbers.h"

#include <algorithm>
#include <stdexcept>

#include "capstan/effects/effect_catalogue.h"

namespace capstan::bench_model {

namespace {

// The catalogue's motor bearing is one whose angle is prescribed. That of a drive of unknown geometry holds
// at rest.
EffectNumbers motor_bearing_at_rest() {
    return {.name = "pulley_friction",
            .variant = "motor holding",
            .title = "pulley friction",
            .meaning = "angle over which the friction of the motor pulley's bearing builds up",
            .numbers = {{"presliding", "rad"}},
            .values_in = [](const BenchEffects& effects) -> std::optional<std::vector<double>> {
                return std::vector{effects.of<PulleyFriction>().motor.presliding_rad};
            },
            .apply =
                [](BenchEffects& effects, std::span<const double> values) {
                    effects.of<PulleyFriction>().motor.presliding_rad = values[0];
                }};
}

bool are_the_same(const BenchEffects& one, const BenchEffects& other) {
    return std::all_of(effect_numbers().begin(), effect_numbers().end(), [&](const EffectNumbers& group) {
        return group.values_in(one) == group.values_in(other);
    });
}

ModelEffect described(const EffectNumbers& group, const std::vector<double>& values) {
    ModelEffect effect{group.name, group.variant, {}};
    for (std::size_t k = 0; k < values.size(); ++k)
        effect.numbers.push_back({group.numbers[k].name, group.numbers[k].unit, values[k]});
    return effect;
}

// A bearing's friction is in the group of a bearing that fades at rest and in that of one that holds.
void drop_what_others_describe(std::vector<ModelEffect>& effects, const BenchEffects& target) {
    for (std::size_t k = effects.size(); k-- > 0;) {
        std::vector<ModelEffect> others = effects;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        if (are_the_same(effects_with(others), target)) effects = std::move(others);
    }
}

}  // namespace

const std::vector<EffectNumbers>& effect_numbers() {
    static const std::vector<EffectNumbers> all = [] {
        std::vector<EffectNumbers> groups;
        for (const Effect& effect : effect_catalogue()) {
            groups.push_back({effect.name,
                              effect.variant,
                              effect.title,
                              effect.meaning,
                              {},
                              effect.values_in,
                              effect.apply});
            for (const EffectParameter& parameter : effect.parameters)
                groups.back().numbers.push_back({parameter.name, parameter.unit});
        }
        groups.push_back(motor_bearing_at_rest());
        return groups;
    }();
    return all;
}

const EffectNumbers* find_effect(const std::string& name, const std::string& variant) {
    for (const EffectNumbers& group : effect_numbers())
        if (group.name == name && group.variant == variant) return &group;
    return nullptr;
}

std::vector<ModelEffect> described_effects(const BenchEffects& effects,
                                           const std::vector<gap::FittedCause>& causes) {
    std::vector<const EffectNumbers*> groups;
    for (const gap::FittedCause& cause : causes) {
        if (const EffectNumbers* group = find_effect(cause.effect, cause.variant)) groups.push_back(group);
    }
    for (const EffectNumbers& group : effect_numbers()) groups.push_back(&group);
    std::vector<ModelEffect> found;
    BenchEffects described_so_far;
    for (const EffectNumbers* group : groups) {
        const auto values = group->values_in(effects);
        if (!values || values == group->values_in(described_so_far)) continue;
        group->apply(described_so_far, *values);
        found.push_back(described(*group, *values));
    }
    drop_what_others_describe(found, effects);
    if (!are_the_same(effects_with(found), effects))
        throw std::logic_error("a diagnosis found effects that effect_numbers() does not describe");
    return found;
}

BenchEffects effects_with(const std::vector<ModelEffect>& described) {
    BenchEffects effects;
    for (const ModelEffect& each : described) {
        std::vector<double> values;
        for (const FittedNumber& number : each.numbers) values.push_back(number.value);
        find_effect(each.name, each.variant)->apply(effects, values);
    }
    return effects;
}

}  // namespace capstan::bench_model
