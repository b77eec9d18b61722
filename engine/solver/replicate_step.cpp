#include "capstan/solver/replicate_step.h"

#include <algorithm>
#include <bit>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/replicate_group.h"

namespace capstan {

ReplicateStep::ReplicateStep(const Cable& cable, const ModelRules& rules) : single_(cable, rules) {}

ReplicateReport ReplicateStep::advance(ReplicateStates& states, const ReplicateEnds& ends) const {
    if (ends.replicates() != states.replicates()) {
        throw InvalidInput({"end conditions are given for " + std::to_string(ends.replicates()) + " of " +
                            std::to_string(states.replicates()) + " replicates; give them for each"});
    }
    const int groups = static_cast<int>(states.motion_.size());
    ReplicateReport report;
    const std::size_t group_size = static_cast<std::size_t>(states.nodes()) * replicates_in_group;
    std::fill(states.verified_.begin(), states.verified_.end(), char{1});
    for (int group = 0; group < groups; ++group) {
        const int members = std::min(states.replicates() - group * replicates_in_group, replicates_in_group);
        ReplicateBits left = (1u << members) - 1u;
        if (single_.rules().check == VelocityCheck::every_node) {
            left &= ~advance_group({single_.tables(), single_.rules().stiction, states.nodes(),
                                    ends.proximal_[group], ends.distal_[group], states.motion_[group],
                                    states.tension_N_.data() + group * group_size,
                                    states.displacement_m_.data() + group * group_size});
        }
        for (; left != 0; left &= left - 1) {
            const int replicate = group * replicates_in_group + std::countr_zero(left);
            states.copy_to(states.alone_, replicate);
            const bool verified = single_.advance(states.alone_, ends.ends(replicate)).verified;
            states.set(replicate, states.alone_);
            states.verified_[replicate] = verified;
            report.unverified += !verified;
            ++report.one_by_one;
        }
    }
    return report;
}

}  // namespace capstan
