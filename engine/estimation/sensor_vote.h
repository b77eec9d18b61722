#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "capstan/estimation/direction_pattern.h"

namespace capstan {

inline constexpr int max_estimated_nodes = max_estimated_segments + 1;

/// Profiles are stored in complete groups of this many nodes.
inline constexpr int profile_group = 4;
constexpr int padded_nodes(int nodes) {
    return (nodes + profile_group - 1) / profile_group * profile_group;
}

/// The single-sensor estimates of one repetition, one per node as if every node had a sensor.
struct SensorEstimates {
    int nodes = 0;
    std::span<const double> tension_N;          // sensors x padded_nodes(nodes); the padding is finite
    std::span<const DirectionBits> directions;  // sensors
    std::span<const std::uint8_t> verified;     // sensors; 0: the estimate is the previous state

    const double* padded_profile_N(int sensor) const {
        return tension_N.data() + static_cast<std::ptrdiff_t>(sensor) * padded_nodes(nodes);
    }
};

/// What a set of sensors decides together before it is averaged: which readings count, and where each
/// estimate agrees with the others about the direction.
struct SensorVote {
    int used = 0;
    bool unanimous = true;                                  ///< every used estimate agrees at every node
    std::array<int, max_estimated_nodes> sensor;            // used
    std::array<std::uint64_t, max_estimated_nodes> agrees;  // used; bit i: at node i

    std::span<const int> sensors() const { return {sensor.data(), static_cast<std::size_t>(used)}; }
};

/// Sensors whose node rests by majority are left out; if that were all, all stay. An unverified estimate
/// counts as agreeing everywhere.
SensorVote take_vote(const SensorEstimates& estimates, std::span<const int> sensors);

}  // namespace capstan
