#pragma once

#include <Eigen/Core>
#include <vector>

#include "capstan/reference/step_problem.h"

namespace capstan::reference {

/// The system of generic_solver.h: one equation and one unknown y [N] a segment. A functor as Eigen's
/// HybridNonLinearSolver asks for it; what was settled by force (E7, mass motion, mu_d after breaking away)
/// stays so until it is settled otherwise.
class SignSystem {
  public:
    using Scalar = double;
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

    /// `problem` must outlive the system.
    explicit SignSystem(const StepProblem& problem);

    int inputs() const { return problem_->segments(); }
    int values() const { return problem_->segments(); }
    int operator()(const Eigen::VectorXd& y_N, Eigen::VectorXd& residual_N) const;
    int df(const Eigen::VectorXd& y_N, Eigen::MatrixXd& jacobian) const;

    double tension_N(const Eigen::VectorXd& y_N, int node) const;
    double increment_m(const Eigen::VectorXd& y_N, int node) const;
    double middle_increment_m(const Eigen::VectorXd& y_N, int s) const { return 2.0 * h(s) * y_N[s]; }

    /// Segments held by mu_s that slide after all get mu_d from now on; false if there is none.
    bool release(const Eigen::VectorXd& y_N);
    /// From now on every segment slides, those before the point of zero velocity `proximal`, those behind it
    /// against them (E7).
    void set_opposed(Direction proximal, int segment);
    /// From now on every segment slides `direction`.
    void set_mass(Direction direction);
    /// The segment under E7; -1: none.
    int opposed() const { return opposed_; }
    /// Which way the segment was made to slide.
    Direction forced(int s) const { return direction_of(forced_[s]); }

    /// The previous solution, shifted by what the ends' inputs alone would shift each end by.
    Eigen::VectorXd shifted_start_N() const;

  private:
    // What an end's middle of segment does to the end node, by E6 and E2.
    class End {
      public:
        End(const StepProblem& problem, const EndCondition& end, int node, double outward);
        double tension_change_N(double y_N) const { return offset_N_ + slope_ * y_N; }
        double increment_m(double y_N) const {
            return twice_h_ * (y_N + outward_ * 0.5 * tension_change_N(y_N));
        }
        double slope() const { return slope_; }
        double increment_slope_m_per_N() const { return twice_h_ * (1.0 + outward_ * 0.5 * slope_); }

      private:
        double twice_h_;
        double outward_;
        double offset_N_;
        double slope_;
    };

    double h(int s) const {
        return problem_->cable.half_compliance_m_per_N * problem_->cable.relative_length[s];
    }
    // 2 h of segment s in parts of the sum with its neighbour's: 1 exactly between equal ones.
    double weight(int s, int neighbour) const { return 2.0 * h(s) / (h(s) + h(neighbour)); }
    double sliding(int s) const { return problem_->cable.sliding_exponent[s]; }
    double breakaway(int s) const { return problem_->cable.breakaway_exponent[s]; }
    // +1 or -1: the segment slides that way; 0: it rests.
    int branch(const Eigen::VectorXd& y_N, int s) const;
    void force(int s, Direction direction);
    double friction_residual_N(const Eigen::VectorXd& y_N, int s) const;
    double opposed_residual_N(const Eigen::VectorXd& y_N, int s) const;
    void add_node(Eigen::MatrixXd& jacobian, int row, int node, double by_tension, double by_increment) const;

    const StepProblem* problem_;
    End proximal_;
    End distal_;
    std::vector<double> limit_;  // segments: L / (T_i + T_{i+1})
    std::vector<int> forced_;    // segments: slides this way whatever its middle does; 0: free
    int opposed_ = -1;           // segment under E7
};

}  // namespace capstan::reference
