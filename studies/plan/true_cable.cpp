#include "capstan/plan/true_cable.h"

namespace capstan {

// A bend that follows the load angle needs a load that turns.
bool is_of_the_cable(const Effect& effect) {
    return (effect.component == "conduit" || effect.component == "cable" ||
            effect.component == "pretension") &&
           effect.name != "moving_bend";
}

CableSpecification true_specification(CableSpecification model, const TrueCable& truth) {
    model.dynamic_friction *= truth.friction_ratio;
    model.static_friction *= truth.friction_ratio;
    model.axial_stiffness_N *= truth.stiffness_ratio;
    model.pretension_N *= truth.pretension_ratio;
    return model;
}

}  // namespace capstan
