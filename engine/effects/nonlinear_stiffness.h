#ifndef CAPSTAN_EFFECTS_NONLINEAR_STIFFNESS_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// A cable that is soft at low tension and stiffens (E31): strain = T / EA + toe (1 - exp(-T / T_toe)). The
/// toe strain is the extension that the strands need before all of them carry load.
template <class Number>
struct NonlinearStiffnessLaw {
    Number toe_strain = 0.0;
    Number toe_tension_N = 10.0;

    bool is_active() const { return toe_strain > 0.0; }
    static std::vector<EffectRow<NonlinearStiffnessLaw>> rows() {
        return {{.about = {.name = "cable_stiffness_nonlinear",
                           .title = "nonlinear cable stiffness",
                           .family = "compliance",
                           .component = "cable",
                           .equation = "E31",
                           .meaning = "a cable that is soft at low tension and stiffens",
                           .changes_the_cable = true,
                           .confusable_with = {"conduit_compliance"},
                           // Nobody knows at which tension the stated stiffness was measured.
                           .stiffness_log_std = 0.5},
                 .parameters = {{{.name = "toe_strain", .high = 0.1, .typical = 1e-3},
                                 &NonlinearStiffnessLaw::toe_strain},
                                {{.name = "toe_tension",
                                  .unit = "N",
                                  .low = 0.1,
                                  .high = 1e4,
                                  .typical = 10.0,
                                  .role = ParameterRole::shape},
                                 &NonlinearStiffnessLaw::toe_tension_N}}}};
    }
};
using NonlinearStiffness = NonlinearStiffnessLaw<double>;

template <class Number>
struct ToeStrain {
    Number strain;
    Number slope;
};

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_NONLINEAR_STIFFNESS_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_NONLINEAR_STIFFNESS_H
CAPSTAN_LAWS_BEGIN

/// The strain beyond T / EA at a tension in units of the toe's, and its slope over that ratio. With a toe
/// strain in metres both are elongations.
template <class Number>
CAPSTAN_LAW ToeStrain<Number> toe_strain(const NonlinearStiffnessLaw<Number>& law, Number ratio) {
    return {law.toe_strain * saturation(ratio), law.toe_strain * exp(negative(ratio))};
}

CAPSTAN_LAWS_END
#endif
