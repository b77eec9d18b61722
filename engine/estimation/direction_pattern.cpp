#include "capstan/estimation/direction_pattern.h"

#include <bit>

namespace capstan {

namespace {

constexpr Direction both_ways[] = {Direction::forward, Direction::backward};

void set(DirectionBits& bits, int segment, Direction direction) {
    const std::uint64_t bit = std::uint64_t{1} << segment;
    if (direction == Direction::forward) bits.forward |= bit;
    if (direction == Direction::backward) bits.backward |= bit;
}

}  // namespace

DirectionBits direction_bits(const DirectionPattern& pattern, int segments) {
    DirectionBits bits{};
    for (int i = 0; i < segments; ++i) set(bits, i, pattern.segment(i, segments));
    return bits;
}

DirectionBits direction_bits(const MotionPattern& pattern, int segments) {
    DirectionBits bits{};
    for (int i = 0; i < segments; ++i) set(bits, i, segment_direction(pattern, i, segments));
    return bits;
}

int hamming_distance(const DirectionBits& a, const DirectionBits& b) {
    return std::popcount((a.forward ^ b.forward) | (a.backward ^ b.backward));
}

std::vector<DirectionPattern> admissible_patterns(int segments) {
    std::vector<DirectionPattern> patterns;
    for (const Direction way : both_ways) patterns.push_back({segments, 0, way, Direction::none});
    for (const Direction way : both_ways) {
        for (int leading = 1; leading < segments; ++leading) {
            patterns.push_back({leading, segments - leading, way, opposite(way)});
        }
    }
    patterns.push_back({});
    for (const Direction way : both_ways) {
        for (int leading = 1; leading < segments; ++leading) {
            patterns.push_back({leading, 0, way, Direction::none});
        }
    }
    for (const Direction way : both_ways) {
        for (int trailing = 1; trailing < segments; ++trailing) {
            patterns.push_back({0, trailing, Direction::none, way});
        }
    }
    for (const Direction way : both_ways) {
        for (const Direction other_way : both_ways) {
            for (int leading = 1; leading < segments; ++leading) {
                for (int trailing = 1; leading + trailing < segments; ++trailing) {
                    patterns.push_back({leading, trailing, way, other_way});
                }
            }
        }
    }
    return patterns;
}

}  // namespace capstan
