#pragma once

#include <algorithm>

#include "capstan/effects/effect_row.h"

namespace capstan {

/// Pretension that falls over a session (E33): T0 (1 - lost t / 100 s).
struct PretensionDrift {
    double lost_by_100_s = 0.0;

    double ratio(double session_time_s) const {
        constexpr double reference_s = 100.0;
        return std::max(0.0, 1.0 - lost_by_100_s * session_time_s / reference_s);
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
                                 &PretensionDrift::lost_by_100_s}}}};
    }
};

}  // namespace capstan
