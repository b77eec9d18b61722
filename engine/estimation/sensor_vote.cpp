#include "capstan/estimation/sensor_vote.h"

#include "capstan/estimation/consensus.h"

namespace capstan {

SensorVote take_vote(const SensorEstimates& estimates, std::span<const int> sensors) {
    const int segments = estimates.nodes - 1;
    const int count = static_cast<int>(sensors.size());
    std::array<DirectionBits, max_estimated_nodes> votes;
    std::array<std::uint64_t, max_estimated_nodes> moving;
    std::uint64_t moving_for_all = ~std::uint64_t{0};
    for (int k = 0; k < count; ++k) {
        votes[k] = estimates.directions[sensors[k]];
        moving[k] = moving_nodes(votes[k]);
        moving_for_all &= moving[k];
    }
    const auto rests_by_majority = [&](int node) {
        if (moving_for_all >> node & 1) return false;
        int resting = 0;
        for (int k = 0; k < count; ++k) resting += static_cast<int>(~moving[k] >> node & 1);
        return 2 * resting > count;
    };

    const DirectionConsensus consensus =
        median_direction(std::span<const DirectionBits>(votes).first(count), segments);
    const std::uint64_t all_nodes = ~std::uint64_t{0} >> (max_estimated_nodes - estimates.nodes);
    SensorVote vote;
    const auto use = [&](int sensor, const DirectionBits& directions) {
        vote.sensor[vote.used] = sensor;
        vote.agrees[vote.used] =
            estimates.verified[sensor] ? agreeing_nodes(directions, consensus, segments) : ~std::uint64_t{0};
        vote.unanimous = vote.unanimous && (vote.agrees[vote.used] & all_nodes) == all_nodes;
        ++vote.used;
    };
    for (int k = 0; k < count; ++k) {
        if (!rests_by_majority(sensors[k])) use(sensors[k], votes[k]);
    }
    if (vote.used == 0) {
        for (int k = 0; k < count; ++k) use(sensors[k], votes[k]);
    }
    return vote;
}

}  // namespace capstan
