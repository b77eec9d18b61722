#pragma once

#include <cstdint>
#include <vector>

#include "capstan/cable/motion_pattern.h"

namespace capstan {

/// A direction for every segment, as an estimator may assume it: `leading` segments slide one way from the
/// proximal end, `trailing` ones from the distal end, those between rest. Mass motion has no trailing ones; a
/// change of direction within a cable that moves throughout has leading + trailing = segments.
struct DirectionPattern {
    int leading = 0;
    int trailing = 0;
    Direction leading_direction = Direction::none;
    Direction trailing_direction = Direction::none;

    Direction segment(int index, int segments) const {
        if (index < leading) return leading_direction;
        return index >= segments - trailing ? trailing_direction : Direction::none;
    }
};

/// The directions as bits, segment i at bit i.
struct DirectionBits {
    std::uint64_t forward;
    std::uint64_t backward;

    friend bool operator==(const DirectionBits&, const DirectionBits&) = default;
};

/// As many segments as DirectionBits holds.
inline constexpr int max_estimated_segments = 63;

DirectionBits direction_bits(const DirectionPattern& pattern, int segments);
DirectionBits direction_bits(const MotionPattern& pattern, int segments);

/// Number of segments whose directions differ.
int hamming_distance(const DirectionBits& a, const DirectionBits& b);

/// All n_p* = 2 N^2 + 1 patterns that the paper admits (its Appendix I, E14): mass motion and rest first,
/// then changes of direction, one-sided, two-sided motion.
std::vector<DirectionPattern> admissible_patterns(int segments);

}  // namespace capstan
