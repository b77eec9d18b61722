#pragma once

#include <string>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// What a laboratory could record next on the same bench.
struct Experiment {
    std::string kind;  ///< "protocol": another motion; "sensor": the same motion with one more sensor
    std::string name;
    std::string description;
    /// One run with its driven channels filled in; what the bench would answer is zero.
    Recording recording;
};

/// Motions that stay within the torque and angle that the recording shows, more pretension, a later session,
/// and a tension sensor at five places along each cable.
std::vector<Experiment> possible_experiments(const Recording& recording);

}  // namespace capstan::gap
