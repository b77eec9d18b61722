#pragma once

namespace capstan {

/// Friction of a pulley's bearing (E27): Coulomb and viscous.
struct PulleyFriction {
    double coulomb_Nm = 0.0;
    double viscous_Nm_s = 0.0;
    /// Also a pulley that is turned from outside keeps its friction at rest, as bristles do; else it fades
    /// below 0.01 rad/s. A pulley that finds its own angle always does.
    bool holds_at_rest = false;
};

}  // namespace capstan
