#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "capstan/estimation/direction_pattern.h"

namespace capstan {

inline constexpr int most_estimated_nodes = most_estimated_segments + 1;

/// The single-sensor estimates of one repetition, one per node as if every node had a sensor.
struct SensorEstimates {
    int nodes = 0;
    std::span<const double> tension_N;          // sensors x nodes
    std::span<const DirectionBits> directions;  // sensors
    std::span<const std::uint8_t> verified;     // sensors; 0: the estimate is the previous state

    std::span<const double> profile_N(int sensor) const {
        return tension_N.subspan(static_cast<std::size_t>(sensor) * nodes, nodes);
    }
};

/// What a set of sensors decides together before it is averaged: which readings count, and where each
/// estimate agrees with the others about the direction.
struct SensorVote {
    int used = 0;
    std::array<int, most_estimated_nodes> sensor;            // used
    std::array<std::uint64_t, most_estimated_nodes> agrees;  // used; bit i: at node i
};

/// Sensors whose node rests by majority are left out; if that were all, all stay. An unverified estimate
/// counts as agreeing everywhere.
SensorVote take_vote(const SensorEstimates& estimates, std::span<const int> sensors);

}  // namespace capstan
