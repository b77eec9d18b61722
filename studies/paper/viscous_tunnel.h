#pragma once

#include <string>
#include <vector>

#include "capstan/paper/pretension_ramps.h"
#include "capstan/recording/recording.h"

namespace capstan::paper {

// The paper's Fig. 6: what a viscous friction term leaves of the residual of Exp. 2. The paper's bench data
// is not published, so the bench is simulated too: the model of Exp. 2 with viscous friction in the conduit,
// with a torque cell's noise, and with a remainder that neither of the two models compared has.

/// The simulated bench. Drag and the remainder's size are set, so that the model without a viscous term
/// leaves the paper's 264 mN m and the model with it about half the sum of squares.
struct ViscousBench {
    double drag_N_s_per_m2 = 4.0;  ///< viscous friction (E20) per length of conduit
    /// Conduit at the handle that bends with it (E26), and the motor's cogging (E28): this many times what is
    /// typical of a bench.
    double remainder = 3.5;
    double load_friction_Nm = 0.05;  ///< of the load pulley's bearing (E27), typical; no model has it either
    double torque_noise_Nm = 0.01;  ///< standard deviation of a sample of the torque cell, as of a 5 N m cell
};

struct ViscousSample {
    double time_s = 0.0;
    double load_angle_rad = 0.0;
    double load_speed_rad_per_s = 0.0;
    double motor_torque_Nm = 0.0;
    double bench_torque_Nm = 0.0;  ///< on the load, as the torque cell reads it
    double bench_motor_angle_rad = 0.0;
    double without_term_Nm = 0.0;  ///< the same of the model without viscous friction
    double with_term_Nm = 0.0;     ///< and with the fitted one
};

/// Residual = offset + slope * handle velocity, by least squares; residual = bench - model.
struct ResidualLine {
    double slope_Nm_s_per_rad = 0.0;
    double offset_Nm = 0.0;
    double sum_of_squares_Nm2 = 0.0;  ///< of the residual itself
    double rms_Nm = 0.0;
};

struct ViscousComparison {
    std::string setting;
    double pretension_N = 0.0;
    ViscousBench bench;
    double fitted_drag_N_s_per_m2 = 0.0;
    std::vector<ViscousSample> samples;
    ResidualLine without_term;
    ResidualLine with_term;
    int unsolved_steps = 0;  ///< of bench and both models

    double reduction() const { return 1.0 - with_term.sum_of_squares_Nm2 / without_term.sum_of_squares_Nm2; }
};

/// Exp. 2 on the bench, the two models moved by the same handle angle and motor torque; the model's drag is
/// the one with the least sum of squares.
ViscousComparison compare_viscous_models(const CableSetting& setting, double pretension_N,
                                         const ViscousBench& bench, const Resolution& resolution);

/// The simulated bench as a recording, with an encoder of 8000 steps a turn on the motor.
Recording recorded_bench(const CableSetting& setting, const ViscousComparison& comparison);

/// What the paper says of its Fig. 6.
struct PaperViscous {
    double rms_without_term_Nm = 0.264;  ///< its model against its bench
    double reduction = 0.5;              ///< of the sum of squares: "about 50%"
};

}  // namespace capstan::paper
