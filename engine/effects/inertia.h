#pragma once

namespace capstan {

/// Moments of inertia that the quasi-static model leaves out (E35): of rotor and motor pulley, of load pulley
/// and handle.
struct Inertia {
    double motor_kg_m2 = 0.0;
    double load_kg_m2 = 0.0;
};

}  // namespace capstan
