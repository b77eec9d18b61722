#pragma once

#include "capstan/effects/bends.h"
#include "capstan/effects/effect_row.h"

namespace capstan {

enum class BentCables { both, only_a, only_b };

/// A tight bend that the routing does not show (E25): extra wrap angle over a short stretch.
struct LocalBend {
    double extra_angle_rad = 0.0;
    double middle_m = 1.0;
    double length_m = 0.15;
    BentCables cables = BentCables::both;

    Stretch stretch() const { return stretch_around(middle_m, length_m); }

    static std::vector<EffectRow<LocalBend>> rows() {
        return {row("both cables", BentCables::both), row("cable A", BentCables::only_a),
                row("cable B", BentCables::only_b)};
    }

  private:
    static EffectRow<LocalBend> row(const std::string& variant, BentCables cables) {
        return {.about = {.name = "local_bend",
                          .variant = variant,
                          .title = "local bend",
                          .family = "friction place",
                          .component = "conduit",
                          .equation = "E25",
                          .meaning = "a tight bend that the routing does not show",
                          .needs_pair = cables != BentCables::both,
                          .changes_the_cable = true,
                          .confusable_with = {"pulley_friction"}},
                .parameters = {{{.name = "angle", .unit = "rad", .high = 20.0, .typical = 0.5},
                                &LocalBend::extra_angle_rad},
                               {middle_of_stretch(), &LocalBend::middle_m},
                               {length_of_stretch(0.15), &LocalBend::length_m}},
                .choose_variant = [cables](LocalBend& bend) { bend.cables = cables; },
                .is_variant = [cables](const LocalBend& bend) { return bend.cables == cables; }};
    }
};

}  // namespace capstan
