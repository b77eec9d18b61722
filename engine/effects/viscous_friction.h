#ifndef CAPSTAN_EFFECTS_VISCOUS_FRICTION_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Drag of the cable in its conduit that grows with the sliding speed, such as from a lubricant (E20): a
/// force per length.
template <class Number>
struct ViscousFrictionLaw {
    Number drag_N_s_per_m2 = 0.0;

    bool is_active() const { return drag_N_s_per_m2 != 0.0; }
    static std::vector<EffectRow<ViscousFrictionLaw>> rows() {
        return {{.about = {.name = "viscous_friction",
                           .title = "viscous friction",
                           .family = "friction law",
                           .component = "conduit",
                           .equation = "E20",
                           .meaning = "drag that grows with sliding speed, as of a lubricant",
                           .changes_the_cable = true,
                           .confusable_with = {"pulley_friction"}},
                 .parameters = {{{.name = "drag", .unit = "N s/m2", .high = 1e4, .typical = 1.0},
                                 &ViscousFrictionLaw::drag_N_s_per_m2}}}};
    }
};
using ViscousFriction = ViscousFrictionLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_VISCOUS_FRICTION_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_VISCOUS_FRICTION_H
CAPSTAN_LAWS_BEGIN

/// Drag of a piece of cable for each metre that it slides in a step; implicit Euler.
template <class Number>
CAPSTAN_LAW Number sliding_drag_N_per_m(const ViscousFrictionLaw<Number>& law, Number length_m,
                                        Number time_step_s) {
    return law.drag_N_s_per_m2 / time_step_s * length_m;
}

CAPSTAN_LAWS_END
#endif
