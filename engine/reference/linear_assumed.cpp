#include "capstan/reference/linear_assumed.h"

#include <Eigen/LU>
#include <cmath>

namespace capstan::reference {

namespace {

class DenseSolver final : public PatternSolver {
  public:
    explicit DenseSolver(int nodes) : matrix_(2 * nodes, 2 * nodes), value_(2 * nodes), lu_(2 * nodes) {}

    bool solve(const StepProblem& problem, const MotionPattern& pattern, CableState& state) override {
        matrix_.setZero();
        PatternEquations(problem, pattern)
            .write([&](int row, int column, double coefficient) { matrix_(row, column) = coefficient; },
                   [&](int row, double value) { value_[row] = value; });
        lu_.compute(matrix_);
        unknown_ = lu_.solve(value_);
        for (int node = 0; node < problem.nodes(); ++node) {
            state.tension_N[node] = unknown_[2 * node];
            state.displacement_m[node] = unknown_[2 * node + 1] * problem.cable.half_compliance_m_per_N;
        }
        return unknown_.allFinite();
    }

  private:
    Eigen::MatrixXd matrix_;
    Eigen::VectorXd value_;
    Eigen::VectorXd unknown_;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace

LinearAssumedSolver::LinearAssumedSolver(const Cable& cable)
    : constants_(cable), solver_(std::make_unique<DenseSolver>(cable.nodes())) {}

LinearAssumedSolver::~LinearAssumedSolver() = default;

ReferenceReport LinearAssumedSolver::advance(CableState& state, const EndConditions& ends) {
    return advance_by_assumption(*solver_, constants_, state, ends);
}

}  // namespace capstan::reference
