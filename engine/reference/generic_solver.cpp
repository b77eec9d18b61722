#include "capstan/reference/generic_solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <unsupported/Eigen/NonLinearOptimization>

#include "capstan/reference/sign_system.h"
#include "capstan/solver/candidate.h"

namespace capstan::reference {

namespace {

// A node that moves less than this is at rest: above the residual's fraction of a displacement, far below a
// step.
constexpr double rest_m = 1e-13;
// Per solve; a hard case takes some tens.
constexpr int max_iterations = 200;

// Until the residual is small or MINPACK gives up, which is false.
bool find_root_from(SignSystem& system, Eigen::VectorXd& y_N, ReferenceReport& report) {
    Eigen::HybridNonLinearSolver<SignSystem> solver(system);
    solver.parameters.xtol = 1e-16;  // the residual decides
    auto status = solver.solveInit(y_N);
    for (int k = 0; k < max_iterations; ++k) {
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

// A lone middle rests between sides that go one way (E8); its node pair slides, so mu_d must hold it.
std::optional<int> held_segment(const MotionPattern& motion, int nodes) {
    const bool one_way =
        motion.kind == MotionKind::partial && motion.proximal_direction == motion.distal_direction;
    if (!one_way || motion.proximal_moving_nodes + motion.distal_moving_nodes != nodes) return std::nullopt;
    return motion.proximal_moving_nodes - 1;
}
bool sliding_friction_holds(const SignSystem& system, const Eigen::VectorXd& y_N, double sliding_ratio,
                            int s) {
    const double a_N = system.tension_N(y_N, s);
    const double b_N = system.tension_N(y_N, s + 1);
    return std::max(a_N, b_N) <= sliding_ratio * std::min(a_N, b_N) * (1.0 + tension_rounding);
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
    const MotionPattern found = motion_of(system, y_N);
    const auto held = held_segment(found, problem.nodes());
    if (held && !(admissible(system, y_N) &&
                  sliding_friction_holds(system, y_N, constants_.sliding_ratio[*held], *held))) {
        system.set_mass(found.proximal_direction);
        if (!find_root(system, y_N, report)) return report;
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
