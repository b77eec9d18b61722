#pragma once

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// How a drive or a band of unknown geometry is described as a bench.
struct BenchEquivalence {
    NominalBench bench;
    double motion_sign = 1.0;  ///< -1: the load angle, or a band's displacement, counts the other way
    double motor_torque_sign = 1.0;
    double load_torque_sign = 1.0;
    double pretension_N = 0.0;                  ///< of a drive, which states none
    double pretension_over_stated_ratio = 1.0;  ///< of a band
};

/// Whether it is one of a drive or a band of unknown geometry.
bool has_unknown_geometry(const Recording& recording);

/// Signs, friction, stiffness and pretension, none of which is stated, as `fitted_to` shows them. A lumped
/// drive becomes a pull-pull pair with one radian of wrap and a motor pulley of 20 mm; a band round a drum
/// becomes a single cable whose ends move together, or whose far end is held where no displacement was
/// recorded. A drive of which not all angles and torques were recorded: see partial_drive.h. Throws
/// InvalidInput if too few channels were recorded, or where the geometry of the recording is known.
BenchEquivalence fit_equivalence(const Recording& fitted_to);

/// The recording in the channels, signs and zeros of that bench.
Recording as_bench(const Recording& recording, const BenchEquivalence& equivalence);

/// Turns a recording of a drive or a band of unknown geometry into one of an equivalent bench, which moves
/// and pulls in the same way, so that a diagnosis can search it for unmodelled effects. A diagnosis lets the
/// numbers that are fitted to `fitted_to` vary about that. Other recordings are returned unchanged. Throws
/// InvalidInput if channels are missing.
Recording equivalent_bench(const Recording& recording, const Recording& fitted_to);

}  // namespace capstan::gap
