#pragma once

#include "capstan/effects/effect_row.h"

namespace capstan {

/// A sheath end or its mount that yields axially under the cable's tension (E30), at either end.
struct ConduitCompliance {
    double motor_m_per_N = 0.0;
    double load_m_per_N = 0.0;

    static std::vector<EffectRow<ConduitCompliance>> rows() {
        return {row("motor", &ConduitCompliance::motor_m_per_N),
                row("load", &ConduitCompliance::load_m_per_N)};
    }

  private:
    static EffectRow<ConduitCompliance> row(const std::string& end, double ConduitCompliance::*compliance) {
        return {.about = {.name = "conduit_compliance",
                          .variant = end,
                          .title = "conduit compliance",
                          .family = "compliance",
                          .component = "conduit",
                          .end = end,
                          .equation = "E30",
                          .meaning = "a sheath end or mount that gives at the " + end,
                          .changes_the_cable = true,
                          .confusable_with = {"environment_coupling"}},
                .parameters = {
                    {{.name = "compliance", .unit = "m/N", .high = 0.1, .typical = 1e-4}, compliance}}};
    }
};

}  // namespace capstan
