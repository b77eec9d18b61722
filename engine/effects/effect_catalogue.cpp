#include "capstan/effects/effect_catalogue.h"

namespace capstan {

namespace {

template <class E>
Effect effect_of(const EffectRow<E>& row) {
    Effect effect;
    static_cast<EffectDescription&>(effect) = row.about;
    E absent;
    for (const auto& [parameter, field] : row.parameters) {
        effect.parameters.push_back(parameter);
        effect.absent.push_back(parameter.absent.value_or(field(absent)));
    }
    effect.apply = [row](BenchEffects& effects, std::span<const double> values) {
        E& applied = effects.of<E>();
        if (row.choose_variant) row.choose_variant(applied);
        for (std::size_t k = 0; k < row.parameters.size(); ++k) row.parameters[k].field(applied) = values[k];
    };
    effect.values_in = [row](const BenchEffects& effects) -> std::optional<std::vector<double>> {
        E present = effects.of<E>();
        if (row.is_variant && !row.is_variant(present)) return {};
        std::vector<double> values;
        for (const auto& parameter : row.parameters) values.push_back(parameter.field(present));
        return values;
    };
    return effect;
}

template <class... Effects>
std::vector<Effect> catalogue_of(const EffectSet<Effects...>&) {
    std::vector<Effect> all;
    const auto add = [&](const auto& rows) {
        for (const auto& row : rows) all.push_back(effect_of(row));
    };
    (add(Effects::rows()), ...);
    return all;
}

}  // namespace

const std::vector<Effect>& effect_catalogue() {
    static const std::vector<Effect> all = catalogue_of(BenchEffects());
    return all;
}

// Built when the program starts. g++ 12 destroys members that do not exist yet when an allocation fails
// within the nested braces of a row, so the rows must not be built where a lack of memory is to be reported.
[[maybe_unused]] static const std::vector<Effect>& built_at_start = effect_catalogue();

EffectValues absent_effects() {
    EffectValues absent;
    for (const Effect& effect : effect_catalogue()) absent.push_back(effect.absent);
    return absent;
}

BenchEffects effects_with(const EffectValues& values) {
    BenchEffects effects;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Effect& effect = effect_catalogue()[k];
        if (values[k] != effect.absent) effect.apply(effects, values[k]);
    }
    return effects;
}

std::vector<std::string> effects_there(const EffectValues& values) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Effect& effect = effect_catalogue()[k];
        if (values[k] == effect.absent) continue;
        names.push_back(effect.variant.empty() ? effect.name : effect.name + " (" + effect.variant + ")");
    }
    return names;
}

}  // namespace capstan
