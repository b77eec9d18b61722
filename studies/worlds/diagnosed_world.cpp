#include "capstan/worlds/diagnosed_world.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capstan/worlds/world.h"

namespace capstan {

namespace {

// 95% lie within this fraction, either way by the same factor; 0 where no interval was stored.
double fraction_of(const std::optional<double>& low, const std::optional<double>& high) {
    if (!low || !high || !(*low > 0.0) || !(*high >= *low)) return 0.0;
    return std::sqrt(*high / *low) - 1.0;
}

double deviation_of(const storage::DiagnosisNumberRecord& number) {
    if (!number.low_in_unit || !number.high_in_unit) return 0.0;
    return std::max(*number.high_in_unit - *number.low_in_unit, 0.0) / (2.0 * deviations_of_95);
}

// The ratios of friction, stiffness and pretension hold it already.
bool is_a_wrong_ratio(const storage::DiagnosisCauseRecord& cause) {
    return cause.effect.starts_with("param_") && cause.variant.empty();
}

// That an effect is there, whatever else is. `confidence_fraction` is shared among causes that act together.
double present_probability(const storage::DiagnosisRecord& diagnosis, const std::string& effect) {
    for (const storage::DiagnosisEffectRecord& each : diagnosis.effects)
        if (each.effect == effect && each.present_fraction) return *each.present_fraction;
    return diagnosis.confidence_fraction;
}

}  // namespace

DiagnosedWorld world_of(const storage::DiagnosisRecord& diagnosis, CableArrangement arrangement) {
    DiagnosedWorld world;
    world.truth.friction_ratio = diagnosis.friction_ratio;
    world.truth.stiffness_ratio = diagnosis.stiffness_ratio;
    world.truth.pretension_ratio = diagnosis.pretension_ratio;
    world.truth.friction_fraction = fraction_of(diagnosis.friction_low_ratio, diagnosis.friction_high_ratio);
    world.truth.stiffness_fraction =
        fraction_of(diagnosis.stiffness_low_ratio, diagnosis.stiffness_high_ratio);
    world.truth.pretension_fraction =
        fraction_of(diagnosis.pretension_low_ratio, diagnosis.pretension_high_ratio);
    const auto& catalogue = effect_catalogue();
    double probability = 1.0;
    for (const storage::DiagnosisCauseRecord& cause : diagnosis.causes) {
        if (is_a_wrong_ratio(cause)) continue;
        // What one cable of a pair has, a single cable can have.
        const bool is_of_b = cause.variant == "cable B" && arrangement == CableArrangement::single;
        const std::string variant = is_of_b ? "cable A" : cause.variant;
        const auto effect = std::find_if(catalogue.begin(), catalogue.end(), [&](const Effect& each) {
            return each.name == cause.effect && each.variant == variant && each.changes_the_cable;
        });
        if (effect == catalogue.end()) {
            world.left_out.push_back(cause.variant.empty() ? cause.effect
                                                           : cause.effect + ", " + cause.variant);
            continue;
        }
        probability = std::min(probability, present_probability(diagnosis, cause.effect));
        const auto at = static_cast<std::size_t>(effect - catalogue.begin());
        std::vector<double>& deviations = world.truth.effect_deviations[at];
        deviations.assign(effect->parameters.size(), 0.0);
        for (std::size_t p = 0; p < effect->parameters.size(); ++p) {
            for (const storage::DiagnosisNumberRecord& number : cause.numbers) {
                if (number.name != effect->parameters[p].name) continue;
                world.truth.effects[at][p] = number.value_in_unit;
                deviations[p] = deviation_of(number);
            }
        }
    }
    if (world.truth.has_effects()) world.probability = probability;
    return world;
}

}  // namespace capstan
