#pragma once

namespace capstan {

/// A spring and a damper between the load pulley and the hand or lock that holds it (E34).
struct EnvironmentCoupling {
    double compliance_rad_per_Nm = 0.0;  ///< 0: rigid
    double damping_Nm_s_per_rad = 0.0;
};

}  // namespace capstan
