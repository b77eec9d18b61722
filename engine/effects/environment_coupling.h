#pragma once

#include "capstan/effects/backlash.h"
#include "capstan/effects/effect_row.h"

namespace capstan {

/// A spring and a damper between the load pulley and the hand or lock that holds it (E34).
struct EnvironmentCoupling {
    double compliance_rad_per_Nm = 0.0;  ///< 0: rigid
    double damping_Nm_s_per_rad = 0.0;

    /// In series with the contact.
    double stiffness_Nm_per_rad() const {
        return 1.0 / (compliance_rad_per_Nm + 1.0 / Backlash::contact_Nm_per_rad);
    }

    static std::vector<EffectRow<EnvironmentCoupling>> rows() {
        return {{.about = {.name = "environment_coupling",
                           .title = "environment coupling",
                           .family = "compliance",
                           .component = "environment",
                           .end = "load",
                           .equation = "E34",
                           .meaning = "a spring and a damper between load pulley and hand",
                           .needs_pair = true},
                 .parameters = {{{.name = "compliance", .unit = "rad/(N m)", .high = 1.0, .typical = 0.01},
                                 &EnvironmentCoupling::compliance_rad_per_Nm},
                                {{.name = "damping", .unit = "N m s/rad", .high = 1e3, .typical = 0.1},
                                 &EnvironmentCoupling::damping_Nm_s_per_rad}}}};
    }
};

}  // namespace capstan
