#pragma once

#include <string>
#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/effects/effect_catalogue.h"

namespace capstan {

/// How the true cable differs from the estimators' model; by default it does not.
struct TrueCable {
    // Factors on the model's values.
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    EffectValues effects = absent_effects();
    // How a study over worlds draws them; elsewhere they have no meaning.
    double friction_fraction =
        0.0;  ///< 95% of the worlds lie so near friction_ratio; 0: as [uncertainty] says
    double stiffness_fraction = 0.0;
    double pretension_fraction = 0.0;
    /// Of each effect's numbers: standard deviations over the worlds; an empty list: none.
    EffectValues effect_deviations = EffectValues(effect_catalogue().size());

    bool has_effects() const { return effects != absent_effects(); }
};

/// The model's cable with the ratios.
CableSpecification true_specification(CableSpecification model, const TrueCable& truth);

}  // namespace capstan
