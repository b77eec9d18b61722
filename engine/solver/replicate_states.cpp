#include "capstan/solver/replicate_states.h"

#include <algorithm>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/solvable_ends.h"

namespace capstan {

namespace {

int groups_of(int replicates) {
    if (replicates < 1) {
        throw InvalidInput(
            {"replicates is " + std::to_string(replicates) + ", but there is nothing to advance below 1"});
    }
    return (replicates + replicates_in_group - 1) / replicates_in_group;
}

EndCondition end_of(const std::vector<EndGroup>& groups, int replicate) {
    const EndGroup& group = groups[replicate / replicates_in_group];
    const int lane = replicate % replicates_in_group;
    return {group.displacement_factor[lane], group.tension_factor[lane], group.value[lane]};
}

void set_end(std::vector<EndGroup>& groups, int replicate, const EndCondition& end) {
    EndGroup& group = groups[replicate / replicates_in_group];
    const int lane = replicate % replicates_in_group;
    group.displacement_factor[lane] = end.displacement_factor;
    group.tension_factor[lane] = end.tension_factor;
    group.value[lane] = end.value;
}

}  // namespace

ReplicateStates::ReplicateStates(const CableState& start, int replicates)
    : replicates_(replicates),
      nodes_(static_cast<int>(start.tension_N.size())),
      motion_(groups_of(replicates)),
      verified_(replicates, 1),
      alone_(start) {
    const std::size_t places = motion_.size() * nodes_ * replicates_in_group;
    tension_N_.resize(places);
    displacement_m_.resize(places);
    for (int replicate = 0; replicate < replicates; ++replicate) set(replicate, start);
}

MotionPattern ReplicateStates::last_motion(int replicate) const {
    const MotionGroup& group = motion_[replicate / replicates_in_group];
    const int lane = replicate % replicates_in_group;
    return {static_cast<MotionKind>(group.kind[lane]),
            static_cast<Direction>(group.proximal_direction[lane]),
            static_cast<Direction>(group.distal_direction[lane]),
            static_cast<int>(group.proximal_moving_nodes[lane]),
            static_cast<int>(group.distal_moving_nodes[lane]),
            group.zero_velocity_fraction[lane]};
}

void ReplicateStates::copy_to(CableState& state, int replicate) const {
    for (int node = 0; node < nodes_; ++node) {
        state.tension_N[node] = tension_N(replicate, node);
        state.displacement_m[node] = displacement_m(replicate, node);
    }
    state.last_motion = last_motion(replicate);
}

CableState ReplicateStates::state(int replicate) const {
    CableState copy = alone_;
    copy_to(copy, replicate);
    return copy;
}

void ReplicateStates::set(int replicate, const CableState& state) {
    for (int node = 0; node < nodes_; ++node) {
        tension_N_[place(replicate, node)] = state.tension_N[node];
        displacement_m_[place(replicate, node)] = state.displacement_m[node];
    }
    const MotionPattern& last = state.last_motion;
    MotionGroup& group = motion_[replicate / replicates_in_group];
    const int lane = replicate % replicates_in_group;
    group.kind[lane] = static_cast<std::int64_t>(last.kind);
    group.proximal_direction[lane] = sign(last.proximal_direction);
    group.distal_direction[lane] = sign(last.distal_direction);
    // The step looks up nodes by these.
    group.proximal_moving_nodes[lane] = std::clamp(last.proximal_moving_nodes, 0, nodes_);
    group.distal_moving_nodes[lane] = std::clamp(last.distal_moving_nodes, 0, nodes_);
    group.zero_velocity_fraction[lane] = last.zero_velocity_fraction;
}

ReplicateEnds::ReplicateEnds(int replicates)
    : replicates_(replicates), proximal_(groups_of(replicates)), distal_(groups_of(replicates)) {
    for (int replicate = 0; replicate < replicates; ++replicate) set(replicate, {});
}

EndConditions ReplicateEnds::ends(int replicate) const {
    return {end_of(proximal_, replicate), end_of(distal_, replicate)};
}

void ReplicateEnds::set(int replicate, const EndConditions& ends) {
    if (!solvable(ends)) refuse(ends);
    set_end(proximal_, replicate, ends.proximal);
    set_end(distal_, replicate, ends.distal);
}

}  // namespace capstan
