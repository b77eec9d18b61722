#pragma once

#include <cmath>

#include "capstan/effects/effect_row.h"

namespace capstan {

/// A motor pulley whose radius changes with its angle (E59): one that sits eccentrically, or a cam. Motion
/// and torque change together, so that no work is lost. At angle 0 its radius is the nominal one.
struct EccentricPulley {
    // Of the radius, in parts of the nominal one.
    double sine = 0.0;
    double cosine = 0.0;

    double radius_ratio(double angle_rad) const {
        return 1.0 + sine * std::sin(angle_rad) + cosine * (std::cos(angle_rad) - 1.0);
    }
    double radius_ratio_per_rad(double angle_rad) const {
        return sine * std::cos(angle_rad) - cosine * std::sin(angle_rad);
    }
    /// The angle by which a round pulley of the nominal radius reels in as much: the integral of
    /// radius_ratio.
    double reeled_rad(double angle_rad) const {
        return angle_rad + sine * (1.0 - std::cos(angle_rad)) + cosine * (std::sin(angle_rad) - angle_rad);
    }

    static std::vector<EffectRow<EccentricPulley>> rows() {
        return {
            {.about = {.name = "eccentric_pulley",
                       .title = "eccentric motor pulley",
                       .family = "actuator",
                       .component = "motor",
                       .end = "motor",
                       .equation = "E59",
                       .meaning = "a motor pulley whose radius changes with its angle",
                       .is_rare = true,
                       .confusable_with = {"position_torque"}},
             .parameters = {
                 {{.name = "sine", .low = -1.0, .high = 1.0, .typical = 0.02}, &EccentricPulley::sine},
                 {{.name = "cosine", .low = -1.0, .high = 1.0, .typical = 0.02}, &EccentricPulley::cosine}}}};
    }
};

}  // namespace capstan
