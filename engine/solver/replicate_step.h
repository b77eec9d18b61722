#pragma once

#include "capstan/solver/quasi_static_step.h"
#include "capstan/solver/replicate_states.h"

namespace capstan {

/// How a step of all replicates went; ReplicateStates::verified says which.
struct ReplicateReport {
    int unverified = 0;  ///< replicates whose step did not verify
    /// Replicates that needed more than the first pattern thought of and were advanced one by one.
    int one_by_one = 0;
};

/// The step of many replicates of one cable, each with a state and end conditions of its own, as many at a
/// time as the processor's vectors hold (Highway, chosen at run time).
///
/// A vector forms, checks and writes rest, partial and mass motion at once, each replicate with its own
/// fronts and directions. Whoever is driven against itself, goes slack or fails the check is taken out and
/// left to QuasiStaticStep, and so is everything under the paper's velocity check. Either way the answer is
/// QuasiStaticStep's, to the bit.
class ReplicateStep {
  public:
    ReplicateStep(const Cable& cable, const ModelRules& rules);

    /// Advances `states` in place. Throws InvalidInput if there are not as many `ends` as states, which
    /// are then unchanged.
    ReplicateReport advance(ReplicateStates& states, const ReplicateEnds& ends) const;

    const QuasiStaticStep& single() const { return single_; }

  private:
    QuasiStaticStep single_;
};

}  // namespace capstan
