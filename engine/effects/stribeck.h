#pragma once

#include <cmath>

namespace capstan {

/// Friction that is higher at low speed (E21): mu = mu_d + extra exp(-(v / v_s)^2), v a low-passed sliding
/// speed. The lag (frictional memory) is what makes it well-posed: without it two simulators of the same
/// equations part.
struct Stribeck {
    double extra_friction = 0.0;
    double speed_m_per_s = 0.05;
    double memory_s = 0.04;

    double friction_added(double lagging_speed_m_per_s) const {
        const double ratio = lagging_speed_m_per_s / speed_m_per_s;
        return extra_friction == 0.0 ? 0.0 : extra_friction * std::exp(-ratio * ratio);
    }
    /// The low-passed speed after a step at `speed_m_per_s_now`.
    double lagging(double before_m_per_s, double now_m_per_s, double time_step_s) const {
        return before_m_per_s + time_step_s / (memory_s + time_step_s) * (now_m_per_s - before_m_per_s);
    }
};

}  // namespace capstan
