#pragma once

#include <cstdint>
#include <span>

#include "capstan/estimation/direction_pattern.h"

namespace capstan {

/// The median direction of each segment over several estimates (paper Sec. II.C). With an even number of
/// estimates the median can fall between two directions; such a segment is `undecided` and no estimate agrees
/// there.
struct DirectionConsensus {
    DirectionBits directions{};
    std::uint64_t undecided = 0;
};

DirectionConsensus median_direction(std::span<const DirectionBits> votes, int segments);

/// Nodes at which an estimate agrees with the consensus: on the segments on both sides of the node. Bit i is
/// node i.
std::uint64_t agreeing_nodes(const DirectionBits& vote, const DirectionConsensus& consensus, int segments);

/// Nodes that move: at least one segment beside them slides. Bit i is node i.
std::uint64_t moving_nodes(const DirectionBits& directions);

}  // namespace capstan
