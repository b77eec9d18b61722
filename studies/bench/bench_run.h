#pragma once

#include <functional>
#include <vector>

#include "capstan/bench/bench_plan.h"

namespace capstan::bench {

/// One sample of a simulated bench.
struct BenchInstant {
    double time_s = 0.0;
    double motor_torque_Nm = 0.0;
    double motor_angle_rad = 0.0;
    double load_torque_Nm = 0.0;
    double load_angle_rad = 0.0;
    bool solved = true;               ///< torque met and motion pattern verified, or Newton converged
    std::vector<double> tension_a_N;  // nodes
    std::vector<double> tension_b_N;  // nodes
};

/// Simulates the plan from rest: by the closed-form step, or with effects by BenchSimulation.
/// Calls `each` with every sample in turn, the first one at rest. Throws InvalidInput if the plan is not
/// a bench.
void simulate_bench(const BenchPlan& plan, const std::function<void(const BenchInstant&)>& each);

}  // namespace capstan::bench
