#pragma once

namespace capstan {

/// Lost motion between a pulley and what it is fixed to (E29): no torque while they are less than half the
/// gap apart.
struct Backlash {
    double half_gap_rad = 0.0;
};

}  // namespace capstan
