#include "capstan/reference/sign_system.h"

#include <cmath>

namespace capstan::reference {

SignSystem::End::End(const StepProblem& problem, const EndCondition& end, int node, double outward)
    : twice_h_(
          2.0 * problem.cable.half_compliance_m_per_N *
          (outward < 0.0 ? problem.cable.relative_length.front() : problem.cable.relative_length.back())),
      outward_(outward) {
    const double change = end.value - end.displacement_factor * problem.before.displacement_m[node] -
                          end.tension_factor * problem.before.tension_N[node];
    const double scale = end.tension_factor + outward * 0.5 * twice_h_ * end.displacement_factor;
    offset_N_ = change / scale;
    slope_ = -twice_h_ * end.displacement_factor / scale;
}

SignSystem::SignSystem(const StepProblem& problem)
    : problem_(&problem),
      proximal_(problem, problem.ends.proximal, 0, -1.0),
      distal_(problem, problem.ends.distal, problem.segments(), 1.0),
      forced_(problem.segments(), 0) {
    for (int s = 0; s < problem.segments(); ++s) {
        limit_.push_back(std::tanh(0.5 * (problem.slid(s) ? sliding(s) : breakaway(s))));
    }
}

int SignSystem::operator()(const Eigen::VectorXd& y_N, Eigen::VectorXd& residual_N) const {
    for (int s = 0; s < inputs(); ++s) {
        residual_N[s] = s == opposed_ ? opposed_residual_N(y_N, s) : friction_residual_N(y_N, s);
    }
    return 0;
}

int SignSystem::df(const Eigen::VectorXd& y_N, Eigen::MatrixXd& jacobian) const {
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

double SignSystem::tension_N(const Eigen::VectorXd& y_N, int node) const {
    const double before_N = problem_->before.tension_N[node];
    if (node == 0) return before_N + proximal_.tension_change_N(y_N[0]);
    if (node == inputs()) return before_N + distal_.tension_change_N(y_N[node - 1]);
    return before_N + (weight(node, node - 1) * y_N[node] - weight(node - 1, node) * y_N[node - 1]);
}

double SignSystem::increment_m(const Eigen::VectorXd& y_N, int node) const {
    if (node == 0) return proximal_.increment_m(y_N[0]);
    if (node == inputs()) return distal_.increment_m(y_N[node - 1]);
    return h(node - 1) * weight(node, node - 1) * (y_N[node - 1] + y_N[node]);
}

int SignSystem::branch(const Eigen::VectorXd& y_N, int s) const {
    if (forced_[s] != 0) return forced_[s];
    const double t0 = tension_N(y_N, s);
    const double t1 = tension_N(y_N, s + 1);
    const double limit_N = limit_[s] * (t0 + t1);
    const double tried_N = t1 - t0 + y_N[s];
    return tried_N >= limit_N ? 1 : tried_N <= -limit_N ? -1 : 0;
}

bool SignSystem::release(const Eigen::VectorXd& y_N) {
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

void SignSystem::set_opposed(Direction proximal, int segment) {
    for (int s = 0; s < inputs(); ++s) force(s, s < segment ? proximal : opposite(proximal));
    opposed_ = segment;
}

void SignSystem::set_mass(Direction direction) {
    for (int s = 0; s < inputs(); ++s) force(s, direction);
    opposed_ = -1;
}

Eigen::VectorXd SignSystem::shifted_start_N() const {
    Eigen::VectorXd y_N(inputs());
    for (int s = 0; s < inputs(); ++s) {
        const double place = (s + 0.5) / inputs();
        y_N[s] =
            ((1.0 - place) * proximal_.increment_m(0.0) + place * distal_.increment_m(0.0)) / (2.0 * h(s));
    }
    return y_N;
}

void SignSystem::force(int s, Direction direction) {
    limit_[s] = std::tanh(0.5 * sliding(s));
    forced_[s] = sign(direction);
}

double SignSystem::friction_residual_N(const Eigen::VectorXd& y_N, int s) const {
    const int side = branch(y_N, s);
    if (side == 0) return -y_N[s];
    const double t0 = tension_N(y_N, s);
    const double t1 = tension_N(y_N, s + 1);
    return t1 - t0 - side * limit_[s] * (t0 + t1);
}

double SignSystem::opposed_residual_N(const Eigen::VectorXd& y_N, int s) const {
    const double d0 = increment_m(y_N, s);
    const double d1 = increment_m(y_N, s + 1);
    const double fraction = (d0 + d1) / (std::abs(d0) + std::abs(d1));
    return tension_N(y_N, s + 1) - tension_N(y_N, s) * std::exp(sliding(s) * fraction);
}

void SignSystem::add_node(Eigen::MatrixXd& jacobian, int row, int node, double by_tension,
                          double by_increment) const {
    if (node == 0) {
        jacobian(row, 0) +=
            by_tension * proximal_.slope() + by_increment * proximal_.increment_slope_m_per_N();
    } else if (node == inputs()) {
        jacobian(row, node - 1) +=
            by_tension * distal_.slope() + by_increment * distal_.increment_slope_m_per_N();
    } else {
        const double by_either = by_increment * h(node - 1) * weight(node, node - 1);
        jacobian(row, node - 1) += -by_tension * weight(node - 1, node) + by_either;
        jacobian(row, node) += by_tension * weight(node, node - 1) + by_either;
    }
}

}  // namespace capstan::reference
