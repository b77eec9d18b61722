#pragma once

#include <cmath>

#include "capstan/reference/step_problem.h"

namespace capstan::reference {

/// Under an assumed motion pattern the step is linear. The same equations for every linear solver, ordered so
/// that the matrix has two bands on either side, and all in newtons.
///
/// Unknowns: T_0, u_0 / h, T_1, u_1 / h, ... (2 x nodes). Patterns as in MotionPattern; `partial` with all
/// nodes moving is E8.
class PatternEquations {
  public:
    static constexpr int bands = 2;

    PatternEquations(const StepProblem& problem, const MotionPattern& pattern)
        : problem_(problem), pattern_(pattern) {}

    /// Calls `entry(row, column, coefficient)` for every coefficient and `value(row, value_N)` for every row.
    template <typename Entry, typename Value>
    void write(const Entry& entry, const Value& value) const;

  private:
    const StepProblem& problem_;
    const MotionPattern& pattern_;
};

/// Solves the linear system of an assumed pattern.
class PatternSolver {
  public:
    virtual ~PatternSolver() = default;
    /// Tensions and displacements of all nodes into `state`; false if the matrix is singular.
    virtual bool solve(const StepProblem& problem, const MotionPattern& pattern, CableState& state) = 0;
};

/// The paper's iteration (Sec. II.B): assume a pattern, starting from the previous one; solve; check; assume
/// the next. Order of the patterns as in engine/README.md, "How a step finds its pattern", but a complete
/// linear system for each. Leaves `state` alone if none verifies.
ReferenceReport advance_by_assumption(PatternSolver& solver, const CableConstants& cable, CableState& state,
                                      const EndConditions& ends);

template <typename Entry, typename Value>
void PatternEquations::write(const Entry& entry, const Value& value) const {
    const double h = problem_.cable.half_compliance_m_per_N;
    const std::vector<double>& length = problem_.cable.relative_length;
    const CableState& before = problem_.before;
    const int nodes = problem_.nodes();
    const auto tension = [](int node) { return 2 * node; };
    const auto displacement = [](int node) { return 2 * node + 1; };
    const auto end = [&](int row, const EndCondition& condition, int node) {  // E6
        const double scale = std::abs(condition.displacement_factor) * h + std::abs(condition.tension_factor);
        entry(row, tension(node), condition.tension_factor / scale);
        entry(row, displacement(node), condition.displacement_factor * h / scale);
        value(row, condition.value / scale);
    };
    const auto sliding = [&](int row, int s, double ratio) {  // E1 or E7, then E2
        entry(row, tension(s), -ratio);
        entry(row, tension(s + 1), 1.0);
        value(row, 0.0);
        entry(row + 1, displacement(s), -1.0);
        entry(row + 1, displacement(s + 1), 1.0);
        entry(row + 1, tension(s), -length[s]);
        entry(row + 1, tension(s + 1), -length[s]);
        value(row + 1, 0.0);
    };
    const auto ratio = [&](int s, Direction direction) {
        const double grown = problem_.cable.sliding_ratio[s];
        return direction == Direction::forward ? grown : 1.0 / grown;
    };
    const bool mass = pattern_.kind == MotionKind::mass;
    const int near = pattern_.proximal_moving_nodes;
    const int far_first = mass ? nodes : nodes - pattern_.distal_moving_nodes;

    if (near > 0) end(0, problem_.ends.proximal, 0);
    for (int s = 0; s + 1 < near; ++s) sliding(2 * s + 1, s, ratio(s, pattern_.proximal_direction));
    if (pattern_.kind == MotionKind::opposed) {
        const double way = sign(pattern_.proximal_direction) * (2.0 * pattern_.zero_velocity_fraction - 1.0);
        sliding(2 * near - 1, near - 1, std::exp(way * problem_.cable.sliding_exponent[near - 1]));
    } else if (near > 0 && near < nodes) {  // E3
        entry(2 * near - 1, tension(near - 1), length[near - 1]);
        entry(2 * near - 1, displacement(near - 1), 1.0);
        value(2 * near - 1, before.displacement_m[near] / h - length[near - 1] * before.tension_N[near]);
    }
    for (int node = near; node < far_first; ++node) {
        entry(tension(node), tension(node), 1.0);
        value(tension(node), before.tension_N[node]);
        entry(displacement(node), displacement(node), 1.0);
        value(displacement(node), before.displacement_m[node] / h);
    }
    if (far_first < nodes) {
        if (pattern_.kind != MotionKind::opposed) {  // E3 from the other side
            const int s = far_first - 1;
            entry(2 * far_first, tension(far_first), -length[s]);
            entry(2 * far_first, displacement(far_first), 1.0);
            value(2 * far_first, before.displacement_m[s] / h + length[s] * before.tension_N[s]);
        }
        for (int s = far_first; s + 1 < nodes; ++s)
            sliding(2 * s + 1, s, ratio(s, pattern_.distal_direction));
    }
    if (mass || far_first < nodes) end(2 * nodes - 1, problem_.ends.distal, nodes - 1);
}

}  // namespace capstan::reference
