#include "capstan/gap/least_squares.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace capstan::gap {

namespace {

// `here`: the residuals at `at`.
Eigen::MatrixXd jacobian_at(const ResidualFunction& residuals, const Eigen::VectorXd& at,
                            const Eigen::VectorXd& here, const LeastSquaresOptions& options) {
    const Eigen::Index count = at.size();
    const bool central = options.differences == Differences::central;
    Eigen::MatrixXd moved = at.replicate(1, central ? 2 * count : count);
    for (Eigen::Index k = 0; k < count; ++k) {
        moved(k, k) += options.difference_step;
        if (central) moved(k, count + k) -= options.difference_step;
    }
    const Eigen::MatrixXd values = residuals(moved);
    if (central) return (values.leftCols(count) - values.rightCols(count)) / (2.0 * options.difference_step);
    return (values.colwise() - here) / options.difference_step;
}

}  // namespace

// Marquardt's scaling by the diagonal; the damping falls after a success and grows until one.
LeastSquaresFit fit_least_squares(const ResidualFunction& residuals, const Eigen::VectorXd& start,
                                  const LeastSquaresOptions& options) {
    constexpr double start_damping = 1e-3;
    constexpr double least_damping = 1e-9;
    constexpr double most_damping = 1e9;
    constexpr double ease = 0.2;
    constexpr double tighten = 5.0;
    constexpr double flat = 1e-12;  // keeps a parameter that changes nothing from making the matrix singular

    const int per_jacobian =
        static_cast<int>(start.size()) * (options.differences == Differences::central ? 2 : 1);
    LeastSquaresFit fit;
    fit.parameters = start;
    fit.residuals = residuals(start);
    fit.sum_of_squares = fit.residuals.squaredNorm();
    fit.evaluations = 1;
    double damping = start_damping;
    for (int iteration = 0; iteration < options.most_iterations && !fit.converged; ++iteration) {
        fit.jacobian = jacobian_at(residuals, fit.parameters, fit.residuals, options);
        fit.evaluations += per_jacobian;
        const Eigen::MatrixXd normal = fit.jacobian.transpose() * fit.jacobian;
        const Eigen::VectorXd gradient = fit.jacobian.transpose() * fit.residuals;
        const double floor = flat * (1.0 + normal.diagonal().maxCoeff());
        while (true) {
            Eigen::MatrixXd damped = normal;
            damped.diagonal().array() += damping * normal.diagonal().array() + floor;
            const Eigen::VectorXd step = -damped.ldlt().solve(gradient);
            const Eigen::VectorXd tried = fit.parameters + step;
            const Eigen::VectorXd there = residuals(tried);
            ++fit.evaluations;
            const double sum = there.squaredNorm();
            const bool better = std::isfinite(sum) && sum < fit.sum_of_squares;
            const bool small = step.cwiseAbs().maxCoeff() <= options.parameter_tolerance;
            if (better) {
                fit.parameters = tried;
                fit.residuals = there;
                fit.sum_of_squares = sum;
                damping = std::max(least_damping, damping * ease);
            }
            fit.converged = small;
            if (better || small) break;
            damping *= tighten;
            if (damping > most_damping) return fit;
        }
    }
    if (options.jacobian_at_end) {
        fit.jacobian = jacobian_at(residuals, fit.parameters, fit.residuals, options);
        fit.evaluations += per_jacobian;
    }
    return fit;
}

}  // namespace capstan::gap
