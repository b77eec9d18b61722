#include "band_lu.h"

#include <algorithm>
#include <cmath>

// LAPACK's own Fortran interface, so that no C header is needed.
extern "C" void dgbsv_(const int* n, const int* kl, const int* ku, const int* nrhs, double* ab,
                       const int* ldab, int* ipiv, double* b, const int* ldb, int* info);

namespace capstan::reference {

namespace {

class BandSolver final : public PatternSolver {
  public:
    explicit BandSolver(int nodes) : matrix_(rows * 2 * nodes), unknown_(2 * nodes), pivots_(2 * nodes) {}

    bool solve(const StepProblem& problem, const MotionPattern& pattern, CableState& state) override {
        std::fill(matrix_.begin(), matrix_.end(), 0.0);
        PatternEquations(problem, pattern)
            .write(
                [&](int row, int column, double coefficient) {
                    matrix_[column * rows + 2 * bands + row - column] = coefficient;
                },
                [&](int row, double value) { unknown_[row] = value; });
        const int size = static_cast<int>(unknown_.size());
        const int one = 1;
        int info = 0;
        dgbsv_(&size, &bands, &bands, &one, matrix_.data(), &rows, pivots_.data(), unknown_.data(), &size,
               &info);
        if (info != 0) return false;
        for (int node = 0; node < problem.nodes(); ++node) {
            state.tension_N[node] = unknown_[2 * node];
            state.displacement_m[node] = unknown_[2 * node + 1] * problem.cable.half_compliance_m_per_N;
        }
        return true;
    }

  private:
    static constexpr int bands = PatternEquations::bands;
    static constexpr int rows = 3 * bands + 1;  // the band and the room that pivoting fills

    std::vector<double> matrix_;   // columns x rows, as dgbsv has it
    std::vector<double> unknown_;  // values going in
    std::vector<int> pivots_;
};

}  // namespace

BandLuSolver::BandLuSolver(const Cable& cable)
    : constants_(cable), solver_(std::make_unique<BandSolver>(cable.nodes())) {}

BandLuSolver::~BandLuSolver() = default;

ReferenceReport BandLuSolver::advance(CableState& state, const EndConditions& ends) {
    return advance_by_assumption(*solver_, constants_, state, ends);
}

}  // namespace capstan::reference
