#pragma once

#include <string>
#include <vector>

#include "capstan/solver/pull_pull.h"

namespace capstan::paper {

/// A routing of the bench's two cables, and the pretensions that go with it.
struct CableSetting {
    std::string name;
    std::string meaning;
    double bend_radius_m = 0.0;         ///< over all of the conduit
    std::vector<double> pretensions_N;  ///< from low to high
};

/// `table_1`: the paper's Table I as it stands, with which the locked load of Exp. 1 feels nothing.
/// `reproduces`: less wrap and less pretension, fitted to the peaks that the paper's figures imply.
const std::vector<CableSetting>& cable_settings();

/// The motor torque of Exp. 1 rises and falls with this slope, and dwells at its peaks.
inline constexpr double slope_Nm_per_s = 0.1;
inline constexpr double dwell_s = 0.5;

/// How finely the bench is computed. The stiction rule (E4) depends on the length of a segment; from 100
/// segments on the peaks move by less than 0.1%.
struct Resolution {
    int segments = 100;
    double time_step_s = 0.005;
};

/// The paper's bench: Table I but for the setting's bend radius and the pretension.
PullPull paper_bench(const CableSetting& setting, double pretension_N, int segments);

struct RampSample {
    double time_s = 0.0;
    double motor_torque_Nm = 0.0;
    double motor_angle_rad = 0.0;
    double load_torque_Nm = 0.0;
    double ideal_load_torque_Nm = 0.0;  ///< of a transmission without friction
};

/// Exp. 1 at one pretension.
struct RampRun {
    std::string setting;
    double pretension_N = 0.0;
    std::vector<RampSample> samples;
    int unsolved_steps = 0;  ///< torque not met or motion pattern not verified

    double peak_load_torque_Nm = 0.0;
    /// Motor torque that a reversal goes through before the load torque changes, mean over the reversals; a
    /// reversal that never reaches the load counts with its complete ramp.
    double dead_width_Nm = 0.0;
    double lost_transfer_ratio = 0.0;  ///< 1 - peak / peak of the ideal transmission
    double rms_to_ideal_Nm = 0.0;
};

/// Motor torque of Exp. 1: ramps of 0.1 N m/s between +-0.125 N m from zero, 0.5 s of dwell at each end.
double ramp_torque_Nm(double time_s);

/// Exp. 1: load locked, 30 s of ramps, from rest.
RampRun run_pretension_ramps(const CableSetting& setting, double pretension_N, const Resolution& resolution);

/// What the paper says about Exp. 1 at one of its four pretensions, whose values it does not give.
struct PaperRamp {
    std::string level;
    double rms_to_ideal_Nm = 0.0;   ///< ideal transmission against the bench
    double rms_of_model_Nm = 0.0;   ///< the paper's model against the bench
    double fraction_of_peak = 0.0;  ///< that, in parts of the peak load torque

    double implied_peak_Nm() const { return rms_of_model_Nm / fraction_of_peak; }
};

/// From low to high, as the pretensions of `reproduces`.
const std::vector<PaperRamp>& papers_ramps();

}  // namespace capstan::paper
