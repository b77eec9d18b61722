#pragma once

namespace capstan {

/// Drag of the cable in its conduit that grows with sliding speed, as of a lubricant (E20): a force per
/// length.
struct ViscousFriction {
    double drag_N_s_per_m2 = 0.0;

    double drag_N(double length_m, double speed_m_per_s) const {
        return drag_N_s_per_m2 * length_m * speed_m_per_s;
    }
};

}  // namespace capstan
