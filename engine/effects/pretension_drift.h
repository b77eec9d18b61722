#pragma once

#include <algorithm>

namespace capstan {

/// Pretension that falls over a session (E33): T0 (1 - lost t / 100 s).
struct PretensionDrift {
    double lost_by_100_s = 0.0;

    double ratio(double session_time_s) const {
        constexpr double reference_s = 100.0;
        return std::max(0.0, 1.0 - lost_by_100_s * session_time_s / reference_s);
    }
};

}  // namespace capstan
