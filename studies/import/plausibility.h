#pragma once

#include <vector>

#include "capstan/import/finding.h"
#include "capstan/recording/recording.h"

namespace capstan::imports {

/// Channels of a recording that contradict physics, each with the unit, sign or exchange that would put it
/// right. Where the bench is known, its nominal model (E1-E8, E15-E17) is compared with the channels: a
/// factor of a unit, a sign or two columns exchanged are named when they alone explain a
/// channel of which more than half of the variance was left, or take four fifths of all that is left. Where
/// it is not known, motor and load are compared: a transmission gives out no more work than it takes in, and
/// friction takes work from the motor. All findings are doubts: nothing is changed. Nothing is said where the
/// recording holds too little to tell.
std::vector<Finding> doubts_of(const Recording& recording);

/// What the nominal model says of a channel in a run, driven by the recording's inputs; empty where it says
/// nothing.
std::vector<double> modelled_channel(const Recording& recording, std::size_t run, std::size_t channel);

}  // namespace capstan::imports
