#pragma once

#include <cstdint>

namespace capstan {

/// Direction of sliding: towards the distal end is positive.
enum class Direction : std::int8_t { backward = -1, none = 0, forward = 1 };

constexpr int sign(Direction direction) {
    return static_cast<int>(direction);
}
constexpr Direction opposite(Direction direction) {
    return static_cast<Direction>(-sign(direction));
}
constexpr Direction direction_of(double increment) {
    return increment > 0.0 ? Direction::forward : increment < 0.0 ? Direction::backward : Direction::none;
}

enum class MotionKind : std::int8_t {
    rest,     ///< no node moves
    partial,  ///< nodes move from one end or both, at least one node between rests
    mass,     ///< all segments slide one way
    opposed,  ///< the two ends slide against each other; zero velocity at a point inside one segment
    slack,    ///< the cable carries nothing
};

/// Which nodes moved in a step, and which way. The proximal side is the first `proximal_moving_nodes` nodes,
/// its last one is the paper's last-moving node k; the distal side, from the other end, gives k'.
/// mass: both sides name all nodes and one direction. opposed: the two counts sum to all nodes.
struct MotionPattern {
    MotionKind kind = MotionKind::rest;
    Direction proximal_direction = Direction::none;
    Direction distal_direction = Direction::none;
    int proximal_moving_nodes = 0;
    int distal_moving_nodes = 0;
    /// opposed only: where in the segment between the sides the velocity is zero, 0 at its proximal node.
    double zero_velocity_fraction = 0.0;

    friend bool operator==(const MotionPattern&, const MotionPattern&) = default;
};

/// Direction in which segment `segment` (from 0, of `segments`) slides along its complete length; `none` for a
/// segment at rest, next to a resting node, or holding the zero-velocity point.
constexpr Direction segment_direction(const MotionPattern& pattern, int segment, int segments) {
    if (pattern.kind == MotionKind::slack) return Direction::none;
    if (segment + 1 < pattern.proximal_moving_nodes) return pattern.proximal_direction;
    if (segment > segments - pattern.distal_moving_nodes) return pattern.distal_direction;
    return Direction::none;
}

/// Direction in which node `node` (from 0) moves.
constexpr Direction node_direction(const MotionPattern& pattern, int node, int segments) {
    if (pattern.kind == MotionKind::slack) return Direction::none;
    if (node < pattern.proximal_moving_nodes) return pattern.proximal_direction;
    if (node > segments - pattern.distal_moving_nodes) return pattern.distal_direction;
    return Direction::none;
}

}  // namespace capstan
