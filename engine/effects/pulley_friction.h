#pragma once

namespace capstan {

/// Friction of a pulley's bearing (E27): Coulomb and viscous.
struct PulleyFriction {
    double coulomb_Nm = 0.0;
    double viscous_Nm_s = 0.0;
};

}  // namespace capstan
