#pragma once

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A recording of a drive or a band of unknown geometry as one of a bench that moves and pulls as it does:
/// what a diagnosis can look for unmodelled effects in.
///
/// A lumped drive becomes a pull-pull pair with one radian of wrap and a motor pulley of 20 mm, signs and
/// zeros read off the recording; a band round a drum becomes a single cable whose ends move together.
/// Friction, stiffness and pretension, which nobody stated, are those that fit `fitted_to` best; a diagnosis
/// lets them float about that. Other recordings come back as they are. Throws InvalidInput if channels are
/// missing.
Recording equivalent_bench(const Recording& recording, const Recording& fitted_to);

}  // namespace capstan::gap
