#ifndef CAPSTAN_EFFECTS_STRIBECK_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// Friction that is higher at low speed (E21): mu = mu_d + extra exp(-(v / v_s)^2), v a low-passed sliding
/// speed. The lag (frictional memory) makes the law well-posed: without it two simulators of the same
/// equations diverge.
template <class Number>
struct StribeckLaw {
    Number extra_friction = 0.0;
    Number speed_m_per_s = 0.05;
    Number memory_s = 0.04;

    bool is_active() const { return extra_friction != 0.0; }
    static std::vector<EffectRow<StribeckLaw>> rows() {
        return {
            {.about = {.name = "stribeck",
                       .title = "Stribeck friction",
                       .family = "friction law",
                       .component = "conduit",
                       .equation = "E21",
                       .meaning = "friction that is higher at low speed, with a lag",
                       .changes_the_cable = true},
             .parameters = {
                 {{.name = "extra_friction", .high = 2.0, .typical = 0.05}, &StribeckLaw::extra_friction},
                 {{.name = "speed",
                   .unit = "m/s",
                   .low = 1e-4,
                   .high = 10.0,
                   .typical = 0.05,
                   .role = ParameterRole::shape},
                  &StribeckLaw::speed_m_per_s},
                 {{.name = "memory", .unit = "s", .high = 1.0, .typical = 0.04, .role = ParameterRole::shape},
                  &StribeckLaw::memory_s}}}};
    }
};
using Stribeck = StribeckLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_STRIBECK_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_STRIBECK_H
CAPSTAN_LAWS_BEGIN

/// What the law adds to mu_d.
template <class Number>
CAPSTAN_LAW Number added_friction(const StribeckLaw<Number>& law, Number lagging_speed_m_per_s) {
    const Number ratio = lagging_speed_m_per_s / law.speed_m_per_s;
    return law.extra_friction * exp(negative(ratio * ratio));
}

/// The low-passed speed after a step.
template <class Number>
CAPSTAN_LAW Number lagging_speed(const StribeckLaw<Number>& law, Number before_m_per_s, Number now_m_per_s,
                                 Number time_step_s) {
    return before_m_per_s + time_step_s / (law.memory_s + time_step_s) * (now_m_per_s - before_m_per_s);
}

CAPSTAN_LAWS_END
#endif
