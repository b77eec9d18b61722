#pragma once

#include <memory>

#include "capstan/reference/assumed_pattern.h"

namespace capstan::reference {

/// The paper's solver as a laboratory writes it: for every assumed pattern a dense system in all 2N + 2
/// unknowns, solved by Eigen's partially pivoting LU. For checks and races only.
class LinearAssumedSolver {
  public:
    explicit LinearAssumedSolver(const Cable& cable);
    ~LinearAssumedSolver();

    /// Advances `state` in place; leaves it alone if no pattern verifies.
    ReferenceReport advance(CableState& state, const EndConditions& ends);

  private:
    CableConstants constants_;
    std::unique_ptr<PatternSolver> solver_;
};

}  // namespace capstan::reference
