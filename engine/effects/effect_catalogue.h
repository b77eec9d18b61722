#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capstan/effects/bench_effects.h"

namespace capstan {

/// One effect that the ideal model leaves out, in one of its variants.
struct Effect : EffectDescription {
    std::vector<EffectParameter> parameters;
    std::vector<double> absent;  ///< parameters without the effect
    std::function<void(BenchEffects&, std::span<const double> parameters)> apply;
    /// The parameters as a bench has them; none where it has another variant of the effect.
    std::function<std::optional<std::vector<double>>(const BenchEffects&)> values_in;
};

/// All of them, grouped by family: the rows of every effect in BenchEffects.
const std::vector<Effect>& effect_catalogue();

/// Parameters of every effect in the catalogue: effects x parameters.
using EffectValues = std::vector<std::vector<double>>;
EffectValues absent_effects();
BenchEffects effects_with(const EffectValues& values);
/// Catalogue names of the effects that are present, variants in brackets.
std::vector<std::string> effects_there(const EffectValues& values);

}  // namespace capstan
