#pragma once

namespace capstan {

/// Friction of a pulley's bearing (E27): Coulomb and viscous.
struct PulleyFriction {
    double coulomb_Nm = 0.0;
    double viscous_Nm_s = 0.0;
    /// Turn over which Coulomb friction builds up, as bristles do, so that it holds at rest. 0: of a pulley
    /// that is turned from outside friction fades below 0.01 rad/s, one that finds its own angle has 1e-4.
    double presliding_rad = 0.0;
};

}  // namespace capstan
