#include "capstan/estimation/consensus.h"

#include <algorithm>
#include <array>
#include <bit>

namespace capstan {

namespace {

std::uint64_t lowest_bits(int count) {
    return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

// Counts, for 64 places at once, in how many masks a bit is set: plane p holds bit p of every place's count.
class BitCounts {
  public:
    void add(std::uint64_t mask) {
        for (std::uint64_t& plane : planes_) {
            const std::uint64_t carry = plane & mask;
            plane ^= mask;
            mask = carry;
            if (mask == 0) return;
        }
    }

    /// Places whose count is at least `threshold`, above 0, when no count is above `most`.
    std::uint64_t at_least(int threshold, int most) const {
        // count >= threshold unless the highest differing bit is set in the threshold only
        std::uint64_t larger = 0;
        std::uint64_t equal = ~std::uint64_t{0};
        for (int p = std::bit_width(static_cast<unsigned>(most)) - 1; p >= 0; --p) {
            const std::uint64_t wanted = threshold >> p & 1 ? ~std::uint64_t{0} : 0;
            larger |= equal & planes_[p] & ~wanted;
            equal &= ~(planes_[p] ^ wanted);
        }
        return larger | equal;
    }

  private:
    static constexpr int planes = 7;  // counts up to 127, votes up to 64
    std::array<std::uint64_t, planes> planes_ = {};
};

}  // namespace

DirectionConsensus median_direction(std::span<const DirectionBits> votes, int segments) {
    const int count = static_cast<int>(votes.size());
    DirectionConsensus consensus;
    if (count == 0) return consensus;
    // Most often all agree, and the median is what they say.
    if (std::all_of(votes.begin(), votes.end(),
                    [&](const DirectionBits& vote) { return vote == votes[0]; })) {
        consensus.directions = votes[0];
        return consensus;
    }
    BitCounts forward;
    BitCounts backward;
    for (const DirectionBits& vote : votes) {
        forward.add(vote.forward);
        backward.add(vote.backward);
    }
    // In rising order the votes are -1s, 0s, +1s. The median is between the votes at places `low` and `high`.
    const int low = (count - 1) / 2;
    const int high = count / 2;
    const std::uint64_t low_backward = backward.at_least(low + 1, count);
    const std::uint64_t high_backward = backward.at_least(high + 1, count);
    const std::uint64_t low_forward = forward.at_least(count - low, count);
    const std::uint64_t high_forward = forward.at_least(count - high, count);
    const std::uint64_t all = lowest_bits(segments);
    consensus.directions.forward = low_forward & all;
    consensus.directions.backward = high_backward & all;
    const std::uint64_t half_backward = low_backward & ~high_backward & ~high_forward;
    const std::uint64_t half_forward = high_forward & ~low_forward & ~low_backward;
    consensus.undecided = (half_backward | half_forward) & all;
    return consensus;
}

std::uint64_t agreeing_nodes(const DirectionBits& vote, const DirectionConsensus& consensus, int segments) {
    const std::uint64_t differs = (vote.forward ^ consensus.directions.forward) |
                                  (vote.backward ^ consensus.directions.backward) | consensus.undecided;
    return ~(differs | differs << 1) & lowest_bits(segments + 1);
}

std::uint64_t moving_nodes(const DirectionBits& directions) {
    const std::uint64_t sliding = directions.forward | directions.backward;
    return sliding | sliding << 1;
}

}  // namespace capstan
