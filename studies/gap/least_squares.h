#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

namespace capstan::gap {

/// Residuals, each in units of its own spread, as a function of the parameters. Called with one column of
/// parameters a column of residuals, so that columns can be worked on side by side.
using ResidualFunction = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& parameters)>;

struct LeastSquaresFit {
    Eigen::VectorXd parameters;
    Eigen::VectorXd residuals;
    Eigen::MatrixXd jacobian;  // residuals x parameters, at the fit
    double sum_of_squares = 0.0;
    int evaluations = 0;  ///< of the residuals for one set of parameters
    bool converged = false;
};

enum class Differences { central, forward };

struct LeastSquaresOptions {
    Differences differences = Differences::central;
    /// Step of the differences. Fronts move in whole segments, so residuals are smooth only on a
    /// scale above this.
    double difference_step = 0.01;
    /// A step that changes no parameter by more than this ends the search.
    double parameter_tolerance = 1e-4;
    int max_iterations = 40;
    bool jacobian_at_end = true;  ///< made once more at the fit, for its covariance
    /// Dampings that are tried side by side after each Jacobian.
    int dampings_at_once = 1;
    /// A search whose linear model promises no less than this is given up after two iterations.
    double pruned_sum_of_squares = std::numeric_limits<double>::infinity();
};

/// Levenberg-Marquardt with the Jacobian by differences, from `start`.
LeastSquaresFit fit_least_squares(const ResidualFunction& residuals, const Eigen::VectorXd& start,
                                  const LeastSquaresOptions& options = {});

}  // namespace capstan::gap
