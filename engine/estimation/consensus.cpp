#include "capstan/estimation/consensus.h"

namespace capstan {

namespace {

std::uint64_t lowest_bits(int count) {
    return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

// The k-th of `backward` times -1, then zeros, then `forward` times +1, in rising order.
int kth_direction(int k, int backward, int forward, int votes) {
    if (k < backward) return -1;
    return k >= votes - forward ? 1 : 0;
}

}  // namespace

DirectionConsensus median_direction(std::span<const DirectionBits> votes, int segments) {
    const int count = static_cast<int>(votes.size());
    DirectionConsensus consensus;
    // Most often everyone agrees, and the median is what they say.
    bool unanimous = true;
    for (const DirectionBits& vote : votes) unanimous = unanimous && vote == votes.front();
    if (unanimous) {
        if (count > 0) consensus.directions = votes.front();
        return consensus;
    }
    for (int segment = 0; segment < segments; ++segment) {
        int forward = 0;
        int backward = 0;
        for (const DirectionBits& vote : votes) {
            forward += static_cast<int>(vote.forward >> segment & 1);
            backward += static_cast<int>(vote.backward >> segment & 1);
        }
        const int twice_median = kth_direction((count - 1) / 2, backward, forward, count) +
                                 kth_direction(count / 2, backward, forward, count);
        const std::uint64_t bit = std::uint64_t{1} << segment;
        if (twice_median == 2) consensus.directions.forward |= bit;
        if (twice_median == -2) consensus.directions.backward |= bit;
        if (twice_median == 1 || twice_median == -1) consensus.undecided |= bit;
    }
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
