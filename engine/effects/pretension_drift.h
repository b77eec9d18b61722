#pragma once

#include <algorithm>
#include <cmath>

#include "capstan/effects/effect_row.h"

namespace capstan {

/// Pretension that falls over a session (E33), ever more slowly as the cable settles: T0 (1 - lost (1 -
/// exp(-t / settling)) / (1 - exp(-100 s / settling))). It falls evenly along the cable, without sliding.
struct PretensionDrift {
    double lost_by_100_s = 0.0;
    double settling_s = steady_s;

    /// Settles so slowly that a session sees a steady fall.
    static constexpr double steady_s = 1e4;

    double ratio(double session_time_s) const {
        constexpr double reference_s = 100.0;
        const double settled =
            std::expm1(-session_time_s / settling_s) / std::expm1(-reference_s / settling_s);
        return std::max(0.0, 1.0 - lost_by_100_s * settled);
    }

    static std::vector<EffectRow<PretensionDrift>> rows() {
        return {{.about = {.name = "pretension_drift",
                           .title = "pretension drift",
                           .family = "pretension",
                           .component = "cable",
                           .equation = "E33",
                           .meaning = "pretension that falls over the session",
                           .changes_the_cable = true,
                           .confusable_with = {"param_T0", "param_mu", "creep"}},
                 .parameters = {{{.name = "lost_by_100_s", .low = -1.0, .high = 1.0, .typical = 0.1},
                                 &PretensionDrift::lost_by_100_s},
                                {{.name = "settling",
                                  .unit = "s",
                                  .low = 10.0,
                                  .high = steady_s,
                                  .typical = 300.0,
                                  .role = ParameterRole::shape},
                                 &PretensionDrift::settling_s}}}};
    }
};

}  // namespace capstan
