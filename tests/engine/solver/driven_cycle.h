#pragma once

#include "capstan/cable/cable.h"
#include "input_pairs.h"

namespace capstan::test {

/// Both ends driven through a closed cycle from rest, the distal end twice as fast as the proximal one.
/// Positions and walls of springs move by up to `amplitude_m`, tensions by the force that stretches the cable
/// as much, and not below 0.
struct DrivenCycle {
    InputPair pair;
    double amplitude_m = 0.0;
    int steps = 0;

    EndConditions ends_at(const Cable& cable, int step) const;
};

}  // namespace capstan::test
