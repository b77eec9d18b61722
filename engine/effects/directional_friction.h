#ifndef CAPSTAN_EFFECTS_DIRECTIONAL_FRICTION_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Friction that is higher one way than the other (E61), as of a strand whose lay lies in the conduit's: mu =
/// mu_d (1 + difference z), z the bristles of E22, 1 where the cable slides away from the motor.
template <class Number>
struct DirectionalFrictionLaw {
    Number difference = 0.0;

    bool is_active() const { return difference != 0.0; }
    static std::vector<EffectRow<DirectionalFrictionLaw>> rows() {
        return {{.about = {.name = "directional_friction",
                           .title = "directional friction",
                           .family = "friction law",
                           .component = "conduit",
                           .equation = "E61",
                           .meaning = "friction that is higher one way than the other",
                           .answered_as = "unknown"},
                 .parameters = {{{.name = "difference", .low = -1.0, .high = 1.0, .typical = 0.1},
                                 &DirectionalFrictionLaw::difference}}}};
    }
};
using DirectionalFriction = DirectionalFrictionLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_DIRECTIONAL_FRICTION_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_DIRECTIONAL_FRICTION_H
CAPSTAN_LAWS_BEGIN

/// Factor on mu.
template <class Number>
CAPSTAN_LAW Number direction_factor(const DirectionalFrictionLaw<Number>& law, Number bend) {
    return constant<Number>(1.0) + law.difference * bend;
}

CAPSTAN_LAWS_END
#endif
