#pragma once

#include "capstan/estimate/tracking.h"
#include "capstan/estimation/recursive_fusion.h"

namespace capstan::estimate {

/// RMS of a channel's readings less what one of the paper's methods says there, each step from its own last
/// estimate, from the channels `used`, each read at the node nearest to it. Its cable has the 10 segments of
/// the paper; of channels that share a node the one with the least noise is read.
double paper_rms_N(const SensedCable& cable, const ChannelSet& used, std::size_t predicted,
                   const FusionMethod& method);

}  // namespace capstan::estimate
