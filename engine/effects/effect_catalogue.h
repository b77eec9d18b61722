#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "capstan/effects/bench_effects.h"

namespace capstan {

/// One number of an effect.
struct EffectParameter {
    std::string name;
    std::string unit;
    double low = 0.0;  ///< limits of what is physical
    double high = std::numeric_limits<double>::infinity();
    double typical = 1.0;  ///< of a mild case on a bench a few metres long: where a fit starts
};

/// One effect that the ideal model leaves out, at one place where it can be.
struct Effect {
    std::string name;     ///< canonical: several entries can share it
    std::string variant;  ///< what sets them apart ("load end"); empty if it is the only one
    std::string family;
    std::string component;
    std::string end;  ///< "motor", "load" or empty
    std::string equation;
    std::string meaning;
    std::vector<EffectParameter> parameters;
    std::vector<double> absent;  ///< parameters at which it is not there
    std::function<void(BenchEffects&, std::span<const double> parameters)> apply;
};

/// All of them, grouped by family.
const std::vector<Effect>& effect_catalogue();

/// Parameters of every effect in the catalogue: effects x parameters.
using EffectValues = std::vector<std::vector<double>>;
EffectValues absent_effects();
BenchEffects effects_with(const EffectValues& values);
/// Catalogue names of the effects that are there, variants in brackets.
std::vector<std::string> effects_there(const EffectValues& values);

}  // namespace capstan
