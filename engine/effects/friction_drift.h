#ifndef CAPSTAN_EFFECTS_FRICTION_DRIFT_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Friction that changes over a session (E62), as a cable wears in, warms up or loses its lubricant: mu =
/// mu_d (1 + change (1 - exp(-t / settling))).
template <class Number>
struct FrictionDriftLaw {
    Number change = 0.0;
    Number settling_s = 30.0;

    bool is_active() const { return change != 0.0; }
    static std::vector<EffectRow<FrictionDriftLaw>> rows() {
        return {
            {.about = {.name = "friction_drift",
                       .title = "friction drift",
                       .family = "friction law",
                       .component = "conduit",
                       .equation = "E62",
                       .meaning = "friction that changes over the session, as a cable wears in or warms up",
                       .answered_as = "unknown"},
             .parameters = {
                 {{.name = "change", .low = -0.9, .high = 10.0, .typical = 0.1}, &FrictionDriftLaw::change},
                 {{.name = "settling",
                   .unit = "s",
                   .low = 1.0,
                   .high = 1e4,
                   .typical = 30.0,
                   .role = ParameterRole::shape},
                  &FrictionDriftLaw::settling_s}}}};
    }
};
using FrictionDrift = FrictionDriftLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_FRICTION_DRIFT_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_FRICTION_DRIFT_H
CAPSTAN_LAWS_BEGIN

/// Factor on mu.
template <class Number>
CAPSTAN_LAW Number session_factor(const FrictionDriftLaw<Number>& law, Number session_time_s) {
    return constant<Number>(1.0) + law.change * saturation(session_time_s / law.settling_s);
}

CAPSTAN_LAWS_END
#endif
