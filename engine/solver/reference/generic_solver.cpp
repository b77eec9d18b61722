#include "capstan/reference/generic_solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unsupported/Eigen/NonLinearOptimization>

namespace capstan::reference {

namespace {

// A node that moves less than this is at rest: above the residual's share of a displacement, far below a
// step.
constexpr double rest_m = 1e-13;
// Rounding of displacements of up to a metre, with three digits to spare (E5).
constexpr double displacement_rounding_m = 1e-12;
// Per solve; a hard case takes some tens.
constexpr int most_iterations = 200;

// The system of generic_solver.h, in the shape that Eigen's HybridNonLinearSolver asks for.
class SignSystem {
  public:
    using Scalar = double;
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

    explicit SignSystem(const StepProblem& problem)
        : problem_(&problem),
          proximal_(problem, problem.ends.proximal, 0, -1.0),
          distal_(problem, problem.ends.distal, problem.segments(), 1.0),
          forced_(problem.segments(), 0) {
        for (int s = 0; s < problem.segments(); ++s) {
            limit_.push_back(std::tanh(0.5 * (problem.slid(s) ? sliding(s) : breakaway(s))));
        }
    }

    int inputs() const { return problem_->segments(); }
    int values() const { return problem_->segments(); }

    int operator()(const Eigen::VectorXd& y_N, Eigen::VectorXd& residual_N) const {
        for (int s = 0; s < inputs(); ++s) {
            residual_N[s] = s == opposed_ ? opposed_residual_N(y_N, s) : friction_residual_N(y_N, s);
        }
        return 0;
    }

    int df(const Eigen::VectorXd& y_N, Eigen::MatrixXd& jacobian) const {
        jacobian.setZero();
        for (int s = 0; s < inputs(); ++s) {
            // Partial derivatives by the tensions and displacements of both nodes and by y.
            double by_t0 = 0.0, by_t1 = 0.0, by_d0 = 0.0, by_d1 = 0.0, by_y = 0.0;
            if (s == opposed_) {
                const double d0 = increment_m(y_N, s);
                const double d1 = increment_m(y_N, s + 1);
                const double t0 = tension_N(y_N, s);
                const double span = std::abs(d0) + std::abs(d1);
                const double ratio = std::exp(sliding(s) * (d0 + d1) / span);
                const double by_fraction = -t0 * ratio * sliding(s) / (span * span);
                by_t0 = -ratio;
                by_t1 = 1.0;
                by_d0 = by_fraction * (span - (d0 + d1) * sign(direction_of(d0)));
                by_d1 = by_fraction * (span - (d0 + d1) * sign(direction_of(d1)));
            } else {
                const int side = branch(y_N, s);
                if (side == 0) {
                    by_y = -1.0;
                } else {
                    by_t0 = -1.0 - side * limit_[s];
                    by_t1 = 1.0 - side * limit_[s];
                }
            }
            add_node(jacobian, s, s, by_t0, by_d0);
            add_node(jacobian, s, s + 1, by_t1, by_d1);
            jacobian(s, s) += by_y;
        }
        return 0;
    }

    double tension_N(const Eigen::VectorXd& y_N, int node) const {
        const double before_N = problem_->before.tension_N[node];
        if (node == 0) return before_N + proximal_.tension_change_N(y_N[0]);
        if (node == inputs()) return before_N + distal_.tension_change_N(y_N[node - 1]);
        return before_N + (y_N[node] - y_N[node - 1]);
    }

    double increment_m(const Eigen::VectorXd& y_N, int node) const {
        if (node == 0) return proximal_.increment_m(y_N[0]);
        if (node == inputs()) return distal_.increment_m(y_N[node - 1]);
        return h() * (y_N[node - 1] + y_N[node]);
    }

    double middle_increment_m(const Eigen::VectorXd& y_N, int s) const { return 2.0 * h() * y_N[s]; }

    /// +1 or -1: the segment slides that way; 0: it rests.
    int branch(const Eigen::VectorXd& y_N, int s) const {
        if (forced_[s] != 0) return forced_[s];
        const double t0 = tension_N(y_N, s);
        const double t1 = tension_N(y_N, s + 1);
        const double limit_N = limit_[s] * (t0 + t1);
        const double tried_N = t1 - t0 + y_N[s];
        return tried_N >= limit_N ? 1 : tried_N <= -limit_N ? -1 : 0;
    }

    /// Segments held by mu_s that slide after all get mu_d from now on; false if there is none.
    bool release(const Eigen::VectorXd& y_N) {
        bool any = false;
        for (int s = 0; s < inputs(); ++s) {
            const double slides = std::tanh(0.5 * sliding(s));
            if (limit_[s] > slides && branch(y_N, s) != 0) {
                limit_[s] = slides;
                any = true;
            }
        }
        return any;
    }

    int opposed() const { return opposed_; }
    Direction forced(int s) const { return direction_of(forced_[s]); }
    /// From now on every segment slides, those before the point of zero velocity `proximal`, those behind it
    /// against them (E7).
    void set_opposed(Direction proximal, int segment) {
        for (int s = 0; s < inputs(); ++s) force(s, s < segment ? proximal : opposite(proximal));
        opposed_ = segment;
    }
    /// From now on every segment slides `direction`.
    void set_mass(Direction direction) {
        for (int s = 0; s < inputs(); ++s) force(s, direction);
        opposed_ = -1;
    }
    void force(int s, Direction direction) {
        limit_[s] = std::tanh(0.5 * sliding(s));
        forced_[s] = sign(direction);
    }

    /// The previous solution, shifted by what the ends' inputs alone would shift each end by.
    Eigen::VectorXd shifted_start_N() const {
        Eigen::VectorXd y_N(inputs());
        for (int s = 0; s < inputs(); ++s) {
            const double place = (s + 0.5) / inputs();
            y_N[s] =
                ((1.0 - place) * proximal_.increment_m(0.0) + place * distal_.increment_m(0.0)) / (2.0 * h());
        }
        return y_N;
    }

  private:
    // What an end's middle of segment does to the end node, by E6 and E2.
    class End {
      public:
        End(const StepProblem& problem, const EndCondition& end, int node, double outward)
            : twice_h_(2.0 * problem.cable.half_compliance_m_per_N), outward_(outward) {
            const double change = end.value - end.displacement_factor * problem.before.displacement_m[node] -
                                  end.tension_factor * problem.before.tension_N[node];
            const double scale = end.tension_factor + outward * 0.5 * twice_h_ * end.displacement_factor;
            offset_N_ = change / scale;
            slope_ = -twice_h_ * end.displacement_factor / scale;
        }
        double tension_change_N(double y_N) const { return offset_N_ + slope_ * y_N; }
        double increment_m(double y_N) const {
            return twice_h_ * (y_N + outward_ * 0.5 * tension_change_N(y_N));
        }
        double slope() const { return slope_; }
        double increment_slope_m_per_N() const { return twice_h_ * (1.0 + outward_ * 0.5 * slope_); }

      private:
        double twice_h_;
        double outward_;
        double offset_N_ = 0.0;
        double slope_ = 0.0;
    };

    double h() const { return problem_->cable.half_compliance_m_per_N; }
    double sliding(int s) const { return problem_->cable.sliding_exponent[s]; }
    double breakaway(int s) const { return problem_->cable.breakaway_exponent[s]; }

    double friction_residual_N(const Eigen::VectorXd& y_N, int s) const {
        const int side = branch(y_N, s);
        if (side == 0) return -y_N[s];
        const double t0 = tension_N(y_N, s);
        const double t1 = tension_N(y_N, s + 1);
        return t1 - t0 - side * limit_[s] * (t0 + t1);
    }

    double opposed_residual_N(const Eigen::VectorXd& y_N, int s) const {
        const double d0 = increment_m(y_N, s);
        const double d1 = increment_m(y_N, s + 1);
        const double fraction = (d0 + d1) / (std::abs(d0) + std::abs(d1));
        return tension_N(y_N, s + 1) - tension_N(y_N, s) * std::exp(sliding(s) * fraction);
    }

    void add_node(Eigen::MatrixXd& jacobian, int row, int node, double by_tension,
                  double by_increment) const {
        if (node == 0) {
            jacobian(row, 0) +=
                by_tension * proximal_.slope() + by_increment * proximal_.increment_slope_m_per_N();
        } else if (node == inputs()) {
            jacobian(row, node - 1) +=
                by_tension * distal_.slope() + by_increment * distal_.increment_slope_m_per_N();
        } else {
            jacobian(row, node - 1) += -by_tension + by_increment * h();
            jacobian(row, node) += by_tension + by_increment * h();
        }
    }

    const StepProblem* problem_;
    End proximal_;
    End distal_;
    std::vector<double> limit_;  // segments: L / (T_i + T_{i+1})
    std::vector<int> forced_;    // segments: slides this way whatever its middle does; 0: free
    int opposed_ = -1;           // segment under E7
};

// Until the residual is small or MINPACK gives up, which is false.
bool find_root_from(SignSystem& system, Eigen::VectorXd& y_N, ReferenceReport& report) {
    Eigen::HybridNonLinearSolver<SignSystem> solver(system);
    solver.parameters.xtol = 1e-16;  // the residual decides
    auto status = solver.solveInit(y_N);
    for (int k = 0; k < most_iterations; ++k) {
        report.residual_N = solver.fvec.cwiseAbs().maxCoeff();
        if (report.residual_N <= GenericSolver::largest_residual_N) return true;
        if (status != Eigen::HybridNonLinearSolverSpace::Running) return false;
        status = solver.solveOneStep(y_N);
        ++report.iterations;
    }
    return false;
}

// MINPACK stalls when rank-one updates carry a Jacobian across a kink, so then anew from where it stands.
bool find_root_near(SignSystem& system, Eigen::VectorXd& y_N, ReferenceReport& report) {
    if (find_root_from(system, y_N, report)) return true;
    return find_root_from(system, y_N, report);
}

// From `y_N`, else from the shifted start and from zero, as its user would do.
bool find_root(SignSystem& system, Eigen::VectorXd& y_N, ReferenceReport& report) {
    if (find_root_near(system, y_N, report)) return true;
    const Eigen::VectorXd zero_N = Eigen::VectorXd::Zero(y_N.size());
    for (const Eigen::VectorXd& start_N : {system.shifted_start_N(), zero_N}) {
        y_N = start_N;
        if (find_root_near(system, y_N, report)) return true;
    }
    return false;
}

// The segment between two nodes that move against each other.
std::optional<int> segment_of_change(const SignSystem& system, const Eigen::VectorXd& y_N) {
    for (int s = 0; s < system.inputs(); ++s) {
        const double d0 = system.increment_m(y_N, s);
        const double d1 = system.increment_m(y_N, s + 1);
        if (std::min(std::abs(d0), std::abs(d1)) > rest_m && d0 * d1 < 0.0) return s;
    }
    return std::nullopt;
}

// Which way a segment slid: that of its middle. The branch does not tell, for a segment at rest may sit
// exactly on its limit.
Direction slid(const SignSystem& system, const Eigen::VectorXd& y_N, int s) {
    if (s == system.opposed()) return Direction::none;
    if (system.forced(s) != Direction::none) return system.forced(s);
    return std::abs(system.middle_increment_m(y_N, s)) > rest_m ? direction_of(y_N[s]) : Direction::none;
}

// Positive tensions and E5.
bool admissible(const SignSystem& system, const Eigen::VectorXd& y_N) {
    for (int node = 0; node <= system.inputs(); ++node) {
        if (!(system.tension_N(y_N, node) > 0.0)) return false;
    }
    for (int s = 0; s < system.inputs(); ++s) {
        const int way = sign(slid(system, y_N, s));
        for (const int node : {s, s + 1}) {
            if (way * system.increment_m(y_N, node) < -displacement_rounding_m) return false;
        }
    }
    return true;
}

// What friction is to remember. A run of sliding segments begins at an end; where none does, the end node may
// have moved alone.
MotionPattern motion_of(const SignSystem& system, const Eigen::VectorXd& y_N) {
    const int segments = system.inputs();
    const Direction first = slid(system, y_N, 0);
    const Direction last = slid(system, y_N, segments - 1);
    int near = 0;
    int far = 0;
    while (first != Direction::none && near < segments && slid(system, y_N, near) == first) ++near;
    if (near == segments) return {MotionKind::mass, first, first, segments + 1, segments + 1, 0.0};
    while (last != Direction::none && slid(system, y_N, segments - 1 - far) == last) ++far;

    const auto end_direction = [&](int node, Direction run) {
        const double d = system.increment_m(y_N, node);
        return run != Direction::none ? run : std::abs(d) > rest_m ? direction_of(d) : Direction::none;
    };
    MotionPattern motion;
    motion.proximal_direction = end_direction(0, first);
    motion.distal_direction = end_direction(segments, last);
    motion.proximal_moving_nodes = motion.proximal_direction == Direction::none ? 0 : near + 1;
    motion.distal_moving_nodes = motion.distal_direction == Direction::none ? 0 : far + 1;
    const bool at_rest = motion.proximal_moving_nodes + motion.distal_moving_nodes == 0;
    motion.kind = at_rest ? MotionKind::rest : MotionKind::partial;
    if (system.opposed() >= 0) {
        const double d0 = system.increment_m(y_N, system.opposed());
        const double d1 = system.increment_m(y_N, system.opposed() + 1);
        motion.kind = MotionKind::opposed;
        motion.zero_velocity_fraction = d0 / (d0 - d1);
    }
    return motion;
}

}  // namespace

ReferenceReport GenericSolver::advance(CableState& state, const EndConditions& ends) const {
    const StepProblem problem{constants_, state, ends};
    SignSystem system(problem);
    ReferenceReport report;
    // The previous solution (y = 0) with the ends where their inputs put them.
    Eigen::VectorXd y_N = Eigen::VectorXd::Zero(problem.segments());
    do {
        if (!find_root(system, y_N, report)) return report;
    } while (system.release(y_N));

    // The point of zero velocity may lie in a segment beside the one that the sign relation found.
    for (int tries = 0; tries <= problem.segments(); ++tries) {
        const auto change = segment_of_change(system, y_N);
        if (!change || *change == system.opposed()) break;
        system.set_opposed(direction_of(system.increment_m(y_N, *change)), *change);
        if (!find_root(system, y_N, report)) return report;
    }
    // E8 counts only where mass motion does not verify.
    const MotionPattern found = motion_of(system, y_N);
    if (found.kind == MotionKind::partial && found.proximal_direction == found.distal_direction &&
        found.proximal_moving_nodes + found.distal_moving_nodes == problem.nodes()) {
        SignSystem mass = system;
        mass.set_mass(found.proximal_direction);
        Eigen::VectorXd mass_N = y_N;
        if (find_root(mass, mass_N, report) && admissible(mass, mass_N)) {
            system = mass;
            y_N = mass_N;
        }
    }
    if (!admissible(system, y_N)) return report;
    CableState after = state;
    for (int node = 0; node < problem.nodes(); ++node) {
        after.tension_N[node] = system.tension_N(y_N, node);
        after.displacement_m[node] += system.increment_m(y_N, node);
    }
    after.last_motion = motion_of(system, y_N);
    state = after;
    report.converged = true;
    return report;
}

}  // namespace capstan::reference
