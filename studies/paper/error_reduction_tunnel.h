#pragma once

#include <string>
#include <vector>

#include "capstan/paper/pretension_ramps.h"

namespace capstan::paper {

struct TunnelSample {
    double time_s = 0.0;
    double load_angle_rad = 0.0;
    double motor_torque_Nm = 0.0;
    double motor_angle_rad = 0.0;
    double load_torque_Nm = 0.0;
    double ideal_load_torque_Nm = 0.0;  ///< of a transmission without friction
};

/// Exp. 2 at one pretension. No viscous friction (the paper's Fig. 6 adds some).
struct TunnelRun {
    std::string setting;
    double pretension_N = 0.0;
    std::vector<TunnelSample> samples;
    int unsolved_steps = 0;  ///< torque not met or motion pattern not verified

    double peak_load_torque_Nm = 0.0;
    double ideal_peak_load_torque_Nm = 0.0;
    double rms_to_ideal_Nm = 0.0;
    /// Area of the loop of load torque over load angle in one period of the motion: work of the handle. The
    /// ideal transmission's loop has none.
    double loop_work_J = 0.0;
    /// Work of handle and motor in that period: what friction took.
    double dissipated_J = 0.0;
};

/// The paper's (7): motor torque that drives the load back into |angle| <= 0.05 rad, at most 0.2 N m.
double tunnel_torque_Nm(double load_angle_rad);

/// A hand that moves the handle to and fro, 40 deg peak to peak: a sum of three sines, chosen once because
/// the paper does not print its participant's motion. Repeats after `handle_period_s`; 0 at time 0.
double handle_angle_rad(double time_s);
inline constexpr double handle_period_s = 10.0;

/// Exp. 2: the handle's angle and the motor torque it asks for are prescribed, two periods from rest; loop
/// and work are of the second.
TunnelRun run_error_reduction_tunnel(const CableSetting& setting, double pretension_N,
                                     const Resolution& resolution);

/// What the paper says about Exp. 2.
struct PaperTunnel {
    double rms_to_ideal_Nm = 0.539;       ///< ideal transmission against the bench
    double rms_to_ideal_by_peak = 0.317;  ///< that, in parts of the peak load torque

    double implied_peak_Nm() const { return rms_to_ideal_Nm / rms_to_ideal_by_peak; }
};

}  // namespace capstan::paper
