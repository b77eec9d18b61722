#pragma once

#include "capstan/reference/step_problem.h"

namespace capstan::reference {

/// The quasi-static step as one nonlinear system with its sign functions left in, for a root finder that
/// knows nothing of cables: MINPACK's hybrid (Powell's dog leg with rank-one updates, analytic Jacobian) as
/// Eigen has it. For checks and races only.
///
/// **Unknowns.** The middle of segment i lies at m_i = u_i + h T_i, which E2 makes equal to
/// u_{i+1} - h T_{i+1}. The increments of the N middles determine everything: between two segments
/// T = T* + (dm_i - dm_{i-1}) / (h_{i-1} + h_i) and u = u* + (h_i dm_{i-1} + h_{i-1} dm_i) / (h_{i-1} + h_i);
/// at an end E6 takes the place of the missing segment. The unknowns are y_i = dm_i / 2h_i, in newtons.
///
/// **Rest.** A segment whose middle stays (dm_i = 0) is at rest: two of them keep the node between at its
/// tension and displacement, the last of a run is E3, and a lone one is E8. So the sign relation of E1 and
/// E4, f = T_{i+1} - T_i equal to sign(dm_i) L when sliding and within [-L, L] at rest, with L =
/// tanh(exponent / 2) (T_i + T_{i+1}), is one equation per segment in the natural map of the complementarity
/// form: f - clamp(f + y_i, -L, L) = 0. No set of resting nodes is assumed. It was chosen over sign(d_i) T_i
/// a as written, where a root finder sits on the jump, and over a smoothed sign, whose answer creeps.
///
/// **Stiction.** With mu_s above mu_d the relation has two branches, and no root finder chooses between them:
/// segments at rest in the step before begin with mu_s, those found sliding get mu_d, and the system is
/// solved again from where it stands, until none is new. That moves the fewest nodes, as the step does.
///
/// **E7.** Where two neighbouring nodes come out moving against each other, with no resting node between,
/// that segment's equation becomes E7 with the fraction eliminated: ln(T_{i+1} / T_i) = a (d_i + d_{i+1}) /
/// (|d_i| + |d_{i+1}|). All other segments then slide, each its side's way, and the segment is moved on until
/// the nodes' increments change sign in it.
///
/// **E8.** A lone middle that rests between sides that go one way must be held by mu_d, and its nodes must
/// move their side's way; where they do not, all slides.
///
/// Started from the previous solution plus the input's increment: the ends where their inputs put them, the
/// middles where they were. Where MINPACK stalls at a kink it is started anew from there, then from middles
/// shifted between the increments of the two ends, then from the first start. Converged means: largest
/// residual at most `largest_residual_N`, all tensions positive (slack is not covered), and each sliding
/// segment's two nodes moved its way (E5).
class GenericSolver {
  public:
    /// A hundredth of the agreement asked for, well above the rounding of tensions of 100 N.
    static constexpr double largest_residual_N = 1e-11;

    explicit GenericSolver(const Cable& cable) : constants_(cable) {}

    /// Advances `state` in place if it converges, and leaves it alone if not.
    ReferenceReport advance(CableState& state, const EndConditions& ends) const;

  private:
    CableConstants constants_;
};

}  // namespace capstan::reference
