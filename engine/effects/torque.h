#pragma once

namespace capstan {

/// A torque and its derivative with respect to the angle.
struct Torque {
    double value_Nm = 0.0;
    double per_rad = 0.0;
};

}  // namespace capstan
