#pragma once

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// Turns a recording of a drive or a band of unknown geometry into one of an equivalent bench, which moves
/// and pulls in the same way, so that a diagnosis can search it for unmodelled effects.
///
/// A lumped drive becomes a pull-pull pair with one radian of wrap and a motor pulley of 20 mm, signs and
/// zeros read off the recording; a band round a drum becomes a single cable whose ends move together.
/// Friction, stiffness and pretension, which are not stated, are fitted to `fitted_to`; a diagnosis lets them
/// vary about that. Other recordings are returned unchanged. Throws InvalidInput if channels are
/// missing.
Recording equivalent_bench(const Recording& recording, const Recording& fitted_to);

}  // namespace capstan::gap
