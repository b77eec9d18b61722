#pragma once

#include "capstan/gap/equivalent_bench.h"

namespace capstan::gap {

/// Whether both angles and both torques of a drive were recorded.
bool is_complete_drive(const Recording& recording);

/// Whether a band was recorded without its displacement.
bool is_band_without_motion(const Recording& recording);

/// Where the fit of a drive begins of which fewer channels were recorded. Torques and angles only set its
/// scales; friction, stiffness and pretension are guesses that a fit moves by factors. Without a load torque
/// a spring is taken to hold the load. Throws InvalidInput where too little was recorded to compare a model
/// with.
BenchEquivalence start_of_partial_drive(const Recording& recording);

/// The recording as one of that bench. What moves it is the motor's angle, else its torque; the load's torque
/// acts on it where that was recorded beside a motor angle. Of two torques alone nothing says how far the
/// load moved: it is taken as held.
Recording bench_of_partial_drive(const Recording& recording, const BenchEquivalence& equivalence);

/// The same of a band of which only both tensions were recorded: it is pulled at the end that the sidecar
/// says is driven, and held at the other.
BenchEquivalence start_of_band_without_motion(const Recording& recording);
Recording bench_of_band_without_motion(const Recording& recording, const BenchEquivalence& equivalence);

}  // namespace capstan::gap
