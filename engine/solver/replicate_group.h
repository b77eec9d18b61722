#pragma once

#include "capstan/solver/model_rules.h"
#include "capstan/solver/prefix_tables.h"
#include "capstan/solver/replicate_states.h"

namespace capstan {

/// A group of replicates as the vector step sees it.
struct ReplicateGroup {
    const PrefixTables& tables;
    StictionRule stiction;
    int nodes = 0;
    const EndGroup& proximal;
    const EndGroup& distal;
    MotionGroup& motion;
    double* tension_N = nullptr;       // nodes x replicates_in_group
    double* displacement_m = nullptr;  // nodes x replicates_in_group
};

/// One bit for each replicate of a group.
using ReplicateBits = std::uint32_t;

/// Advances the replicates whose step is rest, partial or mass motion at the first try, under the check of
/// every node, and says which they are. The others stay as they were.
ReplicateBits advance_group(const ReplicateGroup& group);

}  // namespace capstan
