#include "capstan/plan/true_cable.h"

namespace capstan {

CableSpecification true_specification(CableSpecification model, const TrueCable& truth) {
    model.dynamic_friction *= truth.friction_ratio;
    model.static_friction *= truth.friction_ratio;
    model.axial_stiffness_N *= truth.stiffness_ratio;
    model.pretension_N *= truth.pretension_ratio;
    return model;
}

}  // namespace capstan
