#pragma once

#include <cmath>

#include "capstan/effects/effect_row.h"

namespace capstan {

/// A motor pulley whose radius changes with its angle (E59): one that sits eccentrically, or a cam. Motion
/// and torque change together, so that no work is lost.
struct EccentricPulley {
    // Of the radius, in parts of the nominal one.
    double sine = 0.0;
    double cosine = 0.0;
    double at_zero = 0.0;  ///< how much larger it is at angle 0

    bool is_nominal() const { return sine == 0.0 && cosine == 0.0 && at_zero == 0.0; }
    double radius_ratio(double angle_rad) const {
        if (is_nominal()) return 1.0;
        return 1.0 + at_zero + sine * std::sin(angle_rad) + cosine * (std::cos(angle_rad) - 1.0);
    }
    double radius_ratio_per_rad(double angle_rad) const {
        if (is_nominal()) return 0.0;
        return sine * std::cos(angle_rad) - cosine * std::sin(angle_rad);
    }
    /// The angle by which a round pulley of the nominal radius reels in as much: the integral of
    /// radius_ratio.
    double reeled_rad(double angle_rad) const {
        if (is_nominal()) return angle_rad;
        return (1.0 + at_zero) * angle_rad + sine * (1.0 - std::cos(angle_rad)) +
               cosine * (std::sin(angle_rad) - angle_rad);
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
                 {{.name = "cosine", .low = -1.0, .high = 1.0, .typical = 0.02}, &EccentricPulley::cosine},
                 {{.name = "at_zero", .low = -0.5, .high = 1.0, .typical = 0.02},
                  &EccentricPulley::at_zero}}}};
    }
};

}  // namespace capstan
