#pragma once

#include <memory>

#include "capstan/reference/assumed_pattern.h"

namespace capstan::reference {

/// The paper's solver by a careful programmer: the system of every assumed pattern as a band matrix, two
/// bands on either side of the diagonal, solved by LAPACK's dgbsv; nothing allocated per system. For checks
/// and races only.
class BandLuSolver {
  public:
    explicit BandLuSolver(const Cable& cable);
    ~BandLuSolver();

    /// Advances `state` in place; leaves it alone if no pattern verifies.
    ReferenceReport advance(CableState& state, const EndConditions& ends);

  private:
    CableConstants constants_;
    std::unique_ptr<PatternSolver> solver_;
};

}  // namespace capstan::reference
