#pragma once

namespace capstan {

/// A sheath end or its mount that gives axially under the cable's tension (E30), at either end.
struct ConduitCompliance {
    double motor_m_per_N = 0.0;
    double load_m_per_N = 0.0;
};

}  // namespace capstan
