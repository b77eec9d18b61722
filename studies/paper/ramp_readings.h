#pragma once

#include <optional>
#include <string>
#include <vector>

namespace capstan::paper {

/// Which number over the time of Exp. 1 the paper's "rms error of the ideal transmission" may be.
enum class RampStatistic {
    rms,             ///< over ramps and dwells
    rms_of_ramps,    ///< without the dwells
    rms_of_dwells,   ///< of the dwells alone
    mean_magnitude,  ///< over ramps and dwells
};

/// A way to read the paper's description of Exp. 1: ramps of 0.1 N m/s, 0.5 s of dwell at each end.
struct RampReading {
    std::string name;
    double peak_motor_torque_Nm = 0.0;
    double radius_ratio = 0.0;  ///< load pulley over motor pulley
    RampStatistic statistic = RampStatistic::rms;

    double ideal_peak_Nm() const { return peak_motor_torque_Nm * radius_ratio; }
};

/// A reading at one of the paper's four levels.
struct ReadAtLevel {
    /// Where the peak load torque is the one that the paper implies, within the rounding of its numbers, as
    /// near to the paper's rms as that leaves; nothing: no pretension has that peak.
    std::optional<double> rms_to_ideal_Nm;
    double paper_Nm = 0.0;
    /// The rms of the paper's model against its bench: by the triangle inequality, the rms to the ideal of a
    /// model that is as good can differ by so much from that of the bench.
    double tolerance_Nm = 0.0;

    bool reproduced() const;
};

/// A reading with the bend radius that comes nearest to the paper's four levels.
struct ReadingResult {
    RampReading reading;
    double bend_radius_m = 0.0;       ///< over all of the conduit
    std::vector<ReadAtLevel> levels;  ///< from low to high pretension

    bool reproduces_all() const;
};

struct TorqueRange {
    double low_Nm = 0.0;
    double high_Nm = 0.0;
};

/// The paper's description as it stands, and other readings of it.
struct RampReadings {
    std::vector<ReadingResult> results;
    /// The ideal peak load torques between which all four levels are reproduced, with Table I's ratio: by rms
    /// over ramps and dwells, and over the ramps alone.
    TorqueRange reproducing;
    TorqueRange reproducing_without_dwells;
};
RampReadings compare_ramp_readings();

}  // namespace capstan::paper
