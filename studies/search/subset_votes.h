#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capstan/estimation/sensor_vote.h"

namespace capstan {

/// take_vote() for every set of sensors of one repetition, by counting bits: sensors are bits, and
/// neighbouring segments (nodes) on which all sensors say the same are worked on once.
class SubsetVotes {
  public:
    /// `usable_nodes` as in SensorSubsets: bit p of all masks is the estimate of the p-th usable node.
    explicit SubsetVotes(std::vector<int> usable_nodes) : usable_nodes_(std::move(usable_nodes)) {}

    /// Takes the estimates of a repetition.
    void read(const SensorEstimates& estimates);

    /// The sensors that are used, out of a set that is not empty.
    std::uint64_t used(std::uint64_t set) const;
    /// All sensors of the set say the same of every segment.
    bool alike(std::uint64_t set) const;

    /// Nodes from `first` to `end` - 1 on which the same sensors agree with the consensus.
    struct NodeRun {
        int first = 0;
        int end = 0;
        std::uint64_t agreeing = 0;
    };
    /// Which of `used` agree at which nodes, the consensus being that of `set`. Valid until the next call.
    std::span<const NodeRun> agreement(std::uint64_t set, std::uint64_t used);

  private:
    /// Segments on which each sensor says the same throughout.
    struct SegmentRun {
        int first = 0;
        int end = 0;
        std::uint64_t forward = 0;
        std::uint64_t backward = 0;
        std::uint64_t agreeing = 0;  ///< with the consensus of the set at hand
    };

    std::vector<int> usable_nodes_;
    int nodes_ = 0;
    std::vector<std::uint64_t> resting_;  // places: sensors whose estimate lets that place's node rest
    std::uint64_t perhaps_resting_ = 0;   ///< places with any such sensor
    std::vector<std::uint64_t> same_;     // places: sensors that say the same as that one
    std::uint64_t unverified_ = 0;
    std::vector<SegmentRun> segments_;
    std::vector<NodeRun> runs_;
};

}  // namespace capstan
