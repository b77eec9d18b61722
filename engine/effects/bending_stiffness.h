#ifndef CAPSTAN_EFFECTS_BENDING_STIFFNESS_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// A cable that resists bending presses on its conduit even without tension (E24): a constant drag per length
/// where it slides.
template <class Number>
struct BendingStiffnessLaw {
    Number drag_N_per_m = 0.0;

    bool is_active() const { return drag_N_per_m != 0.0; }
    static std::vector<EffectRow<BendingStiffnessLaw>> rows() {
        return {{.about = {.name = "bending_stiffness",
                           .title = "bending stiffness",
                           .family = "friction law",
                           .component = "conduit",
                           .equation = "E24",
                           .meaning = "constant drag per length, whatever the tension",
                           .changes_the_cable = true,
                           .confusable_with = {"load_dependent_friction"}},
                 .parameters = {{{.name = "drag", .unit = "N/m", .high = 100.0, .typical = 0.2},
                                 &BendingStiffnessLaw::drag_N_per_m}}}};
    }
};
using BendingStiffness = BendingStiffnessLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_BENDING_STIFFNESS_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_BENDING_STIFFNESS_H
CAPSTAN_LAWS_BEGIN

/// Drag of a piece of cable whose bristles are fully bent.
template <class Number>
CAPSTAN_LAW Number constant_drag_N(const BendingStiffnessLaw<Number>& law, Number length_m) {
    return law.drag_N_per_m * length_m;
}

CAPSTAN_LAWS_END
#endif
