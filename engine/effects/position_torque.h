#pragma once

#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// A torque at the motor that depends on its position alone (E52): a return spring, a weight on a lever, a
/// seal or hose that is bent. Adds to the torque that the motor must give.
struct PositionTorque {
    double slope_Nm_per_rad = 0.0;
    double curvature_Nm_per_rad2 = 0.0;

    Torque torque(double angle_rad) const {
        return {(slope_Nm_per_rad + curvature_Nm_per_rad2 * angle_rad) * angle_rad,
                slope_Nm_per_rad + 2.0 * curvature_Nm_per_rad2 * angle_rad};
    }

    static std::vector<EffectRow<PositionTorque>> rows() {
        return {{.about = {.name = "position_torque",
                           .title = "torque that depends on position",
                           .family = "actuator",
                           .component = "motor",
                           .end = "motor",
                           .equation = "E52",
                           .meaning = "a spring, weight or seal at the motor",
                           .confusable_with = {"motor_cogging"}},
                 .parameters = {
                     {{.name = "slope", .unit = "N m/rad", .low = -10.0, .high = 10.0, .typical = 0.02},
                      &PositionTorque::slope_Nm_per_rad},
                     {{.name = "curvature", .unit = "N m/rad2", .low = -10.0, .high = 10.0, .typical = 0.02},
                      &PositionTorque::curvature_Nm_per_rad2}}}};
    }
};

}  // namespace capstan
