#include "capstan/calibration/least_squares.h"

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <utility>
#include <vector>

namespace capstan::gap {

namespace {

// The parameters at which the residuals give the Jacobian, a column each.
Eigen::MatrixXd moved_parameters(const Eigen::VectorXd& at, const LeastSquaresOptions& options) {
    const Eigen::Index count = at.size();
    const bool central = options.differences == Differences::central;
    Eigen::MatrixXd moved = at.replicate(1, central ? 2 * count : count);
    for (Eigen::Index k = 0; k < count; ++k) {
        moved(k, k) += options.difference_step;
        if (central) moved(k, count + k) -= options.difference_step;
    }
    return moved;
}

int evaluations_per_jacobian(const Eigen::VectorXd& parameters, const LeastSquaresOptions& options) {
    return static_cast<int>(parameters.size()) * (options.differences == Differences::central ? 2 : 1);
}

// From the residuals there.
Eigen::MatrixXd differences(const Eigen::Ref<const Eigen::MatrixXd>& values, const Eigen::VectorXd& here,
                            const LeastSquaresOptions& options) {
    if (options.differences == Differences::central) {
        const Eigen::Index count = values.cols() / 2;
        return (values.leftCols(count) - values.rightCols(count)) / (2.0 * options.difference_step);
    }
    return (values.colwise() - here) / options.difference_step;
}

}  // namespace

Eigen::MatrixXd jacobian_at(const ResidualFunction& residuals, const Eigen::VectorXd& at,
                            const Eigen::VectorXd& here, const LeastSquaresOptions& options) {
    return differences(residuals(moved_parameters(at, options)), here, options);
}

Sandwich sandwich_of(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                     const std::vector<Eigen::Index>& block_ends) {
    Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
    Eigen::Index first = 0;
    for (const Eigen::Index end : block_ends) {
        const Eigen::VectorXd score =
            jacobian.middleRows(first, end - first).transpose() * residuals.segment(first, end - first);
        scores += score * score.transpose();
        first = end;
    }
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    Sandwich sandwich;
    sandwich.inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
    sandwich.covariance = sandwich.inverse * scores * sandwich.inverse;
    return sandwich;
}

Eigen::VectorXd jackknife_half_widths(const std::vector<Eigen::VectorXd>& without_a_run,
                                      Eigen::Index parameters) {
    Eigen::VectorXd widths = Eigen::VectorXd::Zero(parameters);
    if (without_a_run.size() < 3) return widths;
    const auto runs = static_cast<double>(without_a_run.size());
    const double quantile = boost::math::quantile(boost::math::students_t(runs - 1.0), 0.975);
    for (Eigen::Index k = 0; k < parameters; ++k) {
        double mean = 0.0;
        for (const Eigen::VectorXd& other : without_a_run) mean += other[k] / runs;
        double squares = 0.0;
        for (const Eigen::VectorXd& other : without_a_run) squares += std::pow(other[k] - mean, 2);
        widths[k] = quantile * std::sqrt((runs - 1.0) / runs * squares);
    }
    return widths;
}

namespace {

// The normal equations of a step.
struct Normal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd gradient;

    Eigen::VectorXd step(double damping) const {
        constexpr double flat = 1e-12;  // keeps a parameter that changes nothing from making it singular
        Eigen::MatrixXd damped = matrix;
        damped.diagonal().array() +=
            damping * matrix.diagonal().array() + flat * (1.0 + matrix.diagonal().maxCoeff());
        return -damped.ldlt().solve(gradient);
    }
    /// By how much the linear model says that the sum of squares falls.
    double decrease(const Eigen::VectorXd& step) const {
        return -2.0 * gradient.dot(step) - step.dot(matrix * step);
    }
};

// A parameter at its bound beyond which the sum would fall takes no part; the others take their steps without
// it (projected Gauss-Newton, D. Bertsekas, SIAM J. Control Optim. 20, 1982, 221-246).
Normal normal_equations(const LeastSquaresFit& fit, const Eigen::VectorXd& lower_bounds) {
    Normal normal{fit.jacobian.transpose() * fit.jacobian, fit.jacobian.transpose() * fit.residuals};
    for (Eigen::Index k = 0; k < lower_bounds.size(); ++k) {
        if (!(fit.parameters[k] <= lower_bounds[k] && normal.gradient[k] > 0.0)) continue;
        normal.matrix.row(k).setZero();
        normal.matrix.col(k).setZero();
        normal.gradient[k] = 0.0;
    }
    return normal;
}

// The derivative along a step that was made is known from the residuals before and after it (C. Broyden,
// Math. Comp. 19, 1965, 577-593).
void correct_along(const Eigen::VectorXd& step, const Eigen::VectorXd& change, Eigen::MatrixXd& jacobian) {
    const double length = step.squaredNorm();
    if (length > 0.0) jacobian += (change - jacobian * step) * (step.transpose() / length);
}

// Marquardt's scaling by the diagonal; the damping falls after a success and grows until one. `is_here`: the
// Jacobian was computed at these parameters.
LeastSquaresFit searched(const ResidualFunction& residuals, LeastSquaresFit fit, bool is_here,
                         const LeastSquaresOptions& options) {
    constexpr double start_damping = 1e-3;
    constexpr double min_damping = 1e-9;
    constexpr double max_damping = 1e9;
    constexpr double ease = 0.2;
    constexpr double tighten = 5.0;
    constexpr int min_iterations = 2;
    constexpr double slow_decreases = 5.0;
    constexpr int max_slow = 2;
    constexpr double as_promised = 0.7;  // of a decrease: the linear model still holds

    const int per_jacobian = evaluations_per_jacobian(fit.parameters, options);
    // Dampings that are tried in parallel span a wider range than those tried in turn.
    const double spread = options.dampings_at_once == 1 ? tighten : tighten * tighten;
    fit.sum_of_squares = fit.residuals.squaredNorm();
    double damping = start_damping;
    int slow = 0;  // steps in turn that lowered the sum little
    bool holds = fit.jacobian.size() > 0 && !is_here;
    for (int iteration = 0; iteration < options.max_iterations && !fit.converged; ++iteration) {
        const bool is_corrected = holds && (options.secant || iteration == 0);
        if (!is_corrected && !(is_here && iteration == 0)) {
            fit.jacobian = jacobian_at(residuals, fit.parameters, fit.residuals, options);
            fit.evaluations += per_jacobian;
            is_here = true;
        }
        holds = false;
        const Normal normal = normal_equations(fit, options.lower_bounds);
        const double promised = normal.decrease(normal.step(0.0));
        if (iteration >= min_iterations && fit.sum_of_squares - promised > options.pruned_sum_of_squares)
            return fit;
        if (promised < options.min_decrease) {
            if (options.jacobian_at_end && !is_here) continue;  // a corrected Jacobian may be wrong
            fit.converged = true;
            break;
        }
        const double before = fit.sum_of_squares;
        while (true) {
            std::vector<double> dampings;
            Eigen::MatrixXd tried = fit.parameters.replicate(1, options.dampings_at_once);
            for (int k = 0; k < options.dampings_at_once; ++k) {
                dampings.push_back(damping * std::pow(spread, k));
                tried.col(k) += normal.step(dampings.back());
            }
            if (options.lower_bounds.size() > 0)
                tried = tried.cwiseMax(options.lower_bounds.replicate(1, tried.cols()));
            const Eigen::MatrixXd there = residuals(tried);
            fit.evaluations += options.dampings_at_once;
            Eigen::VectorXd sums = there.colwise().squaredNorm();
            for (double& sum : sums)
                if (!std::isfinite(sum)) sum = std::numeric_limits<double>::infinity();
            Eigen::Index best = 0;
            const double sum = sums.minCoeff(&best);
            const bool better = sum < fit.sum_of_squares;
            // The least damped step shows how far the minimum is.
            const bool small =
                (tried.col(0) - fit.parameters).cwiseAbs().maxCoeff() <= options.parameter_tolerance;
            if (better) {
                const Eigen::VectorXd step = tried.col(best) - fit.parameters;
                holds = fit.sum_of_squares - sum > as_promised * normal.decrease(step);
                if (options.secant) correct_along(step, there.col(best) - fit.residuals, fit.jacobian);
                is_here = false;
                fit.parameters = tried.col(best);
                fit.residuals = there.col(best);
                fit.sum_of_squares = sum;
                damping = std::max(min_damping, dampings[static_cast<std::size_t>(best)] * ease);
            }
            fit.converged = small;
            if (better || small || is_corrected) break;  // a corrected Jacobian may be wrong: once more
            damping = dampings.back() * tighten;
            if (damping > max_damping) return fit;
        }
        if (is_corrected && fit.sum_of_squares == before) continue;
        slow = before - fit.sum_of_squares < slow_decreases * options.min_decrease ? slow + 1 : 0;
        fit.converged |= slow == max_slow;
    }
    if (options.jacobian_at_end && !is_here) {
        fit.jacobian = jacobian_at(residuals, fit.parameters, fit.residuals, options);
        fit.evaluations += per_jacobian;
    }
    return fit;
}

}  // namespace

// The start and its Jacobian at once: simulations of several sets of parameters move side by side.
LeastSquaresFit fit_least_squares(const ResidualFunction& residuals, const Eigen::VectorXd& start,
                                  const LeastSquaresOptions& options) {
    LeastSquaresFit fit;
    fit.parameters = start;
    if (options.lower_bounds.size() > 0) fit.parameters = start.cwiseMax(options.lower_bounds);
    const Eigen::MatrixXd moved = moved_parameters(fit.parameters, options);
    Eigen::MatrixXd all(moved.rows(), 1 + moved.cols());
    all << fit.parameters, moved;
    const Eigen::MatrixXd values = residuals(all);
    fit.residuals = values.col(0);
    fit.jacobian = differences(values.rightCols(moved.cols()), fit.residuals, options);
    fit.evaluations = 1 + evaluations_per_jacobian(fit.parameters, options);
    return searched(residuals, std::move(fit), true, options);
}

LeastSquaresFit fit_least_squares(const ResidualFunction& residuals, LeastSquaresFit start,
                                  const LeastSquaresOptions& options) {
    return searched(residuals, std::move(start), false, options);
}

}  // namespace capstan::gap
