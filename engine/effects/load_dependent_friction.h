#ifndef CAPSTAN_EFFECTS_LOAD_DEPENDENT_FRICTION_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// A friction coefficient that changes with the normal force per length N' = T / R (E23, Hertzian contact of
/// a sheath's liner): mu = mu_d (N' / N'_0)^(exponent - 1).
template <class Number>
struct LoadDependentFrictionLaw {
    Number exponent = 1.0;  ///< 1: Coulomb
    Number reference_N_per_m = 10.0;

    bool is_active() const { return exponent != 1.0; }
    static std::vector<EffectRow<LoadDependentFrictionLaw>> rows() {
        return {{.about = {.name = "load_dependent_friction",
                           .title = "load-dependent friction",
                           .family = "friction law",
                           .component = "conduit",
                           .equation = "E23",
                           .meaning = "a friction coefficient that changes with the normal force",
                           .changes_the_cable = true,
                           .friction_log_std = 0.1},  // of mu_d at a reference load that nobody measured
                 .parameters = {{{.name = "exponent", .low = 0.2, .high = 2.0, .typical = 0.8},
                                 &LoadDependentFrictionLaw::exponent},
                                {{.name = "reference",
                                  .unit = "N/m",
                                  .low = 1e-3,
                                  .high = 1e4,
                                  .typical = 10.0,
                                  .role = ParameterRole::normal_force},
                                 &LoadDependentFrictionLaw::reference_N_per_m}}}};
    }
};
using LoadDependentFriction = LoadDependentFrictionLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_LOAD_DEPENDENT_FRICTION_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_LOAD_DEPENDENT_FRICTION_H
CAPSTAN_LAWS_BEGIN

/// Factor on mu; the normal force is limited to the range in which a power law can be trusted.
template <class Number>
CAPSTAN_LAW Number friction_factor(const LoadDependentFrictionLaw<Number>& law, Number normal_force_N_per_m) {
    const Number low = constant<Number>(0.05);
    const Number high = constant<Number>(20.0);
    const Number ratio = min(high, max(low, normal_force_N_per_m / law.reference_N_per_m));
    return pow(ratio, law.exponent - constant<Number>(1.0));
}

CAPSTAN_LAWS_END
#endif
