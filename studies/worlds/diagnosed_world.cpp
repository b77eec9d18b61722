#include "capstan/worlds/diagnosed_world.h"

#include <algorithm>

namespace capstan {

DiagnosedWorld world_of(const storage::DiagnosisRecord& diagnosis) {
    DiagnosedWorld world;
    world.truth.friction_ratio = diagnosis.friction_ratio;
    world.truth.stiffness_ratio = diagnosis.stiffness_ratio;
    world.truth.pretension_ratio = diagnosis.pretension_ratio;
    const auto& catalogue = effect_catalogue();
    for (const storage::DiagnosisCauseRecord& cause : diagnosis.causes) {
        // What one cable of a pair has, a single cable can have.
        const std::string variant = cause.variant == "cable B" ? "cable A" : cause.variant;
        const auto effect = std::find_if(catalogue.begin(), catalogue.end(), [&](const Effect& each) {
            return each.name == cause.effect && each.variant == variant && each.changes_the_cable;
        });
        if (effect == catalogue.end()) {
            world.left_out.push_back(cause.variant.empty() ? cause.effect
                                                           : cause.effect + ", " + cause.variant);
            continue;
        }
        auto& values = world.truth.effects[static_cast<std::size_t>(effect - catalogue.begin())];
        for (std::size_t p = 0; p < effect->parameters.size(); ++p) {
            for (const storage::DiagnosisNumberRecord& number : cause.numbers)
                if (number.name == effect->parameters[p].name) values[p] = number.value_in_unit;
        }
    }
    if (world.truth.has_effects()) world.probability = diagnosis.confidence_fraction;
    return world;
}

}  // namespace capstan
