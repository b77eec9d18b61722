#include "capstan/estimation/sensor_vote.h"

#include "capstan/estimation/consensus.h"

namespace capstan {

SensorVote take_vote(const SensorEstimates& estimates, std::span<const int> sensors) {
    const int segments = estimates.nodes - 1;
    const int count = static_cast<int>(sensors.size());
    std::array<DirectionBits, most_estimated_nodes> votes;
    std::array<std::uint64_t, most_estimated_nodes> moving;
    for (int k = 0; k < count; ++k) {
        votes[k] = estimates.directions[sensors[k]];
        moving[k] = moving_nodes(votes[k]);
    }
    const auto rests_by_majority = [&](int node) {
        int resting = 0;
        for (int k = 0; k < count; ++k) resting += static_cast<int>(~moving[k] >> node & 1);
        return 2 * resting > count;
    };

    const DirectionConsensus consensus =
        median_direction(std::span<const DirectionBits>(votes).first(count), segments);
    SensorVote vote;
    const auto use = [&](int sensor, const DirectionBits& directions) {
        vote.sensor[vote.used] = sensor;
        vote.agrees[vote.used] =
            estimates.verified[sensor] ? agreeing_nodes(directions, consensus, segments) : ~std::uint64_t{0};
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
