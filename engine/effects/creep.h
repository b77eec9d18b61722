#ifndef CAPSTAN_EFFECTS_CREEP_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// A viscoelastic cable (E32, Kelvin-Voigt element in series): strain that follows `ratio` T / EA with a time
/// constant.
template <class Number>
struct CreepLaw {
    Number ratio = 0.0;
    Number time_constant_s = 2.0;

    bool is_active() const { return ratio > 0.0; }
    static std::vector<EffectRow<CreepLaw>> rows() {
        return {{.about = {.name = "creep",
                           .title = "cable creep",
                           .family = "compliance",
                           .component = "cable",
                           .equation = "E32",
                           .meaning = "strain that follows tension over seconds",
                           .changes_the_cable = true},
                 .parameters = {{{.name = "ratio", .high = 10.0, .typical = 0.2}, &CreepLaw::ratio},
                                {{.name = "time_constant",
                                  .unit = "s",
                                  .low = 0.05,
                                  .high = 100.0,
                                  .typical = 2.0,
                                  .role = ParameterRole::shape},
                                 &CreepLaw::time_constant_s}}}};
    }
};
using Creep = CreepLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_CREEP_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_CREEP_H
CAPSTAN_LAWS_BEGIN

/// The creep at rest, for an elastic elongation or compliance.
template <class Number>
CAPSTAN_LAW Number creep_at_rest(const CreepLaw<Number>& law, Number elastic) {
    return law.ratio * elastic;
}

/// The fraction of the way to rest that creep covers in a step; implicit Euler.
template <class Number>
CAPSTAN_LAW Number creep_fraction(const CreepLaw<Number>& law, Number time_step_s) {
    const Number zero = constant<Number>(0.0);
    return select(is_greater(law.ratio, zero), time_step_s / (law.time_constant_s + time_step_s), zero);
}

CAPSTAN_LAWS_END
#endif
