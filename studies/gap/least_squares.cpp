#include "capstan/gap/least_squares.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace capstan::gap {

namespace {

Eigen::MatrixXd central_differences(const ResidualFunction& residuals, const Eigen::VectorXd& at,
                                    double step) {
    const Eigen::Index count = at.size();
    Eigen::MatrixXd moved = at.replicate(1, 2 * count);
    for (Eigen::Index k = 0; k < count; ++k) {
        moved(k, 2 * k) += step;
        moved(k, 2 * k + 1) -= step;
    }
    const Eigen::MatrixXd values = residuals(moved);
    Eigen::MatrixXd jacobian(values.rows(), count);
    for (Eigen::Index k = 0; k < count; ++k)
        jacobian.col(k) = (values.col(2 * k) - values.col(2 * k + 1)) / (2.0 * step);
    return jacobian;
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

    LeastSquaresFit fit;
    fit.parameters = start;
    fit.residuals = residuals(start);
    fit.sum_of_squares = fit.residuals.squaredNorm();
    fit.evaluations = 1;
    double damping = start_damping;
    for (int iteration = 0; iteration < options.most_iterations && !fit.converged; ++iteration) {
        fit.jacobian = central_differences(residuals, fit.parameters, options.difference_step);
        fit.evaluations += 2 * static_cast<int>(start.size());
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
    fit.jacobian = central_differences(residuals, fit.parameters, options.difference_step);
    fit.evaluations += 2 * static_cast<int>(start.size());
    return fit;
}

}  // namespace capstan::gap
