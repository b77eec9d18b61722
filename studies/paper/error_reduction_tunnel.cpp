#include "capstan/paper/error_reduction_tunnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace capstan::paper {

double tunnel_torque_Nm(double load_angle_rad) {
    constexpr double half_width_rad = 0.05;
    constexpr double stiffness_Nm_per_rad = 0.5;
    constexpr double highest_torque_Nm = 0.2;
    const double way_back_rad = std::clamp(load_angle_rad, -half_width_rad, half_width_rad) - load_angle_rad;
    return std::clamp(stiffness_Nm_per_rad * way_back_rad, -highest_torque_Nm, highest_torque_Nm);  // (7)
}

double handle_angle_rad(double time_s) {
    // 5, 3 and 11 turns in a period; the scale makes extremes 40 deg apart.
    const double base_rad = 2.0 * std::numbers::pi * time_s / handle_period_s;
    constexpr double scale_rad = 0.31574;
    return scale_rad *
           (std::sin(5.0 * base_rad) + 0.15 * std::sin(3.0 * base_rad) + 0.06 * std::sin(11.0 * base_rad));
}

TunnelRun run_error_reduction_tunnel(const CableSetting& setting, double pretension_N,
                                     const Resolution& resolution) {
    const PullPull bench = paper_bench(setting, pretension_N, resolution.segments);
    PullPullState state = bench.at_rest();
    TunnelRun run;
    run.setting = setting.name;
    run.pretension_N = pretension_N;

    const int period = static_cast<int>(std::lround(handle_period_s / resolution.time_step_s));
    const int steps = 2 * period;
    double squares = 0.0;
    TunnelSample before;
    for (int step = 1; step <= steps; ++step) {
        const double time_s = step * resolution.time_step_s;
        const double angle_rad = handle_angle_rad(time_s);
        const double torque_Nm = tunnel_torque_Nm(angle_rad);
        const PullPullReport report = bench.advance(state, {MotorTorque{torque_Nm}, LoadAngle{angle_rad}});
        const TunnelSample now{time_s,
                               angle_rad,
                               torque_Nm,
                               state.motor_angle_rad,
                               bench.load_torque_Nm(state),
                               bench.ideal_load_torque_Nm(torque_Nm)};
        if (!report.solved()) ++run.unsolved_steps;
        run.peak_load_torque_Nm = std::max(run.peak_load_torque_Nm, std::abs(now.load_torque_Nm));
        run.ideal_peak_load_torque_Nm =
            std::max(run.ideal_peak_load_torque_Nm, std::abs(now.ideal_load_torque_Nm));
        squares += std::pow(now.load_torque_Nm - now.ideal_load_torque_Nm, 2);
        if (step > period) {
            // The handle works against the torque on the load.
            const double handle_J = -0.5 * (before.load_torque_Nm + now.load_torque_Nm) *
                                    (now.load_angle_rad - before.load_angle_rad);
            const double motor_J = 0.5 * (before.motor_torque_Nm + now.motor_torque_Nm) *
                                   (now.motor_angle_rad - before.motor_angle_rad);
            run.loop_work_J += handle_J;
            run.dissipated_J += handle_J + motor_J;
        }
        run.samples.push_back(now);
        before = now;
    }
    run.rms_to_ideal_Nm = std::sqrt(squares / steps);
    return run;
}

}  // namespace capstan::paper
