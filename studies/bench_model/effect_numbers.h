#pragma once

#include "capstan/bench_model/bench_model.h"

namespace capstan::bench_model {

/// A group of numbers of the bench's effects: a row of the engine's catalogue, or what no row has.
struct EffectNumbers {
    struct Number {
        std::string name;
        std::string unit;
    };
    std::string name;
    std::string variant;
    std::string title;
    std::string meaning;
    std::vector<Number> numbers;
    std::function<std::optional<std::vector<double>>(const BenchEffects&)> values_in;
    std::function<void(BenchEffects&, std::span<const double>)> apply;
};

/// All that BenchEffects holds.
const std::vector<EffectNumbers>& effect_numbers();

/// Null if the group does not exist.
const EffectNumbers* find_effect(const std::string& name, const std::string& variant);

/// The groups that are present, as few as describe these effects. `causes` decide where several could.
/// Throws std::logic_error if no groups do.
std::vector<ModelEffect> described_effects(const BenchEffects& effects,
                                           const std::vector<gap::FittedCause>& causes);

/// The effects that such groups describe.
BenchEffects effects_with(const std::vector<ModelEffect>& described);

}  // namespace capstan::bench_model
