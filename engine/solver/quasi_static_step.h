#pragma once

#include <span>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"
#include "capstan/solver/model_rules.h"
#include "capstan/solver/prefix_tables.h"

namespace capstan {

/// How a step went, beside the state that came out.
struct StepReport {
    MotionPattern pattern;
    bool verified = true;  ///< the pattern passed the rules' velocity check and friction cones
};

/// One quasi-static step in closed form: from a state and what is known at both ends to the next state.
///
/// Each sliding side has one unknown scale (E1-E3). A side's front starts where it was if its direction has
/// not changed, else at the end, and moves on while the neighbour at rest cannot hold (E4). When no resting
/// node is left, the middle of the segment between rests if friction holds it (E8); else all slides, or the
/// zero-velocity point lies inside a segment (E7). O(nodes).
///
/// Several states can pass every check of a step. The answer is the one that continuous motion from the
/// previous state reaches, the limit of sub-steps: to rounding, and with a zero-velocity point to first order
/// in the step (engine/README.md has where stiction makes an exception).
///
/// The answer that comes out is checked node by node; one that fails is still written and reported as not
/// verified, never dropped.
class QuasiStaticStep {
  public:
    QuasiStaticStep(const Cable& cable, const ModelRules& rules);

    /// Advances `state` in place. Throws InvalidInput if an end condition or what it asks of this cable is no
    /// finite number, if a spring pushes back the wrong way, or if both ends prescribe a tension (the
    /// displacement would be undetermined); `state` is then unchanged.
    StepReport advance(CableState& state, const EndConditions& ends) const;

    /// Takes other friction exponents (segments: mu_d times wrap angle), and mu_s as mu_d, for the steps that
    /// follow: friction that depends on speed (E41). Allocates nothing. Throws InvalidInput under rules other
    /// than ElongationRule::mean_tension, or if there are not as many as segments.
    void set_sliding_exponents(std::span<const double> exponents);

    const Cable& cable() const { return cable_; }
    const ModelRules& rules() const { return rules_; }
    const PrefixTables& tables() const { return tables_; }

  private:
    Cable cable_;
    ModelRules rules_;
    PrefixTables tables_;
};

}  // namespace capstan
