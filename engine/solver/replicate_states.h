#pragma once

#include <cstdint>
#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"
#include "capstan/solver/prefix_tables.h"

namespace capstan {

/// Replicates lie in groups of a cache line of doubles; processors with shorter vectors take a group in
/// parts.
inline constexpr int replicates_in_group = 8;

/// The last motions of a group; a MotionPattern for each replicate, turned on its side.
struct MotionGroup {
    std::int64_t kind[replicates_in_group] = {};
    std::int64_t proximal_direction[replicates_in_group] = {};
    std::int64_t distal_direction[replicates_in_group] = {};
    std::int64_t proximal_moving_nodes[replicates_in_group] = {};
    std::int64_t distal_moving_nodes[replicates_in_group] = {};
    double zero_velocity_fraction[replicates_in_group] = {};
};

/// States of many replicates of one cable, arranged for ReplicateStep.
class ReplicateStates {
  public:
    /// All of them start as `start`. Throws InvalidInput if there is no replicate.
    ReplicateStates(const CableState& start, int replicates);

    int replicates() const { return replicates_; }
    int nodes() const { return nodes_; }
    double tension_N(int replicate, int node) const { return tension_N_[place(replicate, node)]; }
    double displacement_m(int replicate, int node) const { return displacement_m_[place(replicate, node)]; }
    MotionPattern last_motion(int replicate) const;
    /// Whether the replicate's last step verified (StepReport::verified).
    bool verified(int replicate) const { return verified_[replicate] != 0; }

    CableState state(int replicate) const;
    /// `state` has as many nodes as the others.
    void set(int replicate, const CableState& state);

  private:
    friend class ReplicateStep;

    std::size_t place(int replicate, int node) const {
        const std::size_t group = replicate / replicates_in_group;
        return (group * nodes_ + node) * replicates_in_group + replicate % replicates_in_group;
    }
    void copy_to(CableState& state, int replicate) const;

    int replicates_;
    int nodes_;
    NodeTable tension_N_;              // groups x nodes x replicates_in_group
    NodeTable displacement_m_;         // groups x nodes x replicates_in_group
    std::vector<MotionGroup> motion_;  // groups
    std::vector<char> verified_;       // replicates
    CableState alone_;                 // room for a replicate that is taken out of its group
};

/// The end conditions of a group, each a line u, T, value as in EndCondition.
struct EndGroup {
    double displacement_factor[replicates_in_group] = {};
    double tension_factor[replicates_in_group] = {};
    double value[replicates_in_group] = {};
};

/// What is known at both ends of every replicate. Each can be solved: `set` sees to it.
class ReplicateEnds {
  public:
    /// All ends at displacement 0.
    explicit ReplicateEnds(int replicates);

    int replicates() const { return replicates_; }
    EndConditions ends(int replicate) const;
    /// Throws InvalidInput as QuasiStaticStep::advance does; the ends are then unchanged.
    void set(int replicate, const EndConditions& ends);

  private:
    friend class ReplicateStep;

    int replicates_;
    std::vector<EndGroup> proximal_;  // groups
    std::vector<EndGroup> distal_;    // groups
};

}  // namespace capstan
