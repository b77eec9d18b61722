#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

namespace capstan::gap {

/// Residuals, each in units of its own spread, as a function of the parameters. A column of parameters gives
/// a column of residuals, so that several can be computed in parallel.
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
    /// Step of the differences. Fronts move by complete segments, so residuals are smooth only on a
    /// scale above this.
    double difference_step = 0.01;
    /// The least value of each parameter; empty: none has one. A parameter that rests at it does not move as
    /// long as the sum of squares would fall beyond it.
    Eigen::VectorXd lower_bounds{};
    /// A step that changes no parameter by more than this ends the search.
    double parameter_tolerance = 1e-4;
    /// A search ends when a step promises to lower the sum of squares by less than this, or two in turn
    /// lower it by less than five times this.
    double min_decrease = 0.0;
    int max_iterations = 40;
    /// The Jacobian is computed at the fit, for its covariance, and no search ends on a corrected one.
    bool jacobian_at_end = true;
    /// After a step that lowers the sum about as far as promised, the Jacobian is corrected along that step
    /// instead of computed again.
    bool secant = false;
    /// The number of dampings that are tried in parallel after each Jacobian.
    int dampings_at_once = 1;
    /// After two iterations, a search is given up if its linear model promises more than this.
    double pruned_sum_of_squares = std::numeric_limits<double>::infinity();
};

/// The derivatives of the residuals at `at`, where they are `here`: residuals x parameters.
Eigen::MatrixXd jacobian_at(const ResidualFunction& residuals, const Eigen::VectorXd& at,
                            const Eigen::VectorXd& here, const LeastSquaresOptions& options = {});

/// How a fit spreads, by the sandwich: residuals may be correlated within a block in any way, and are
/// independent between blocks.
struct Sandwich {
    Eigen::MatrixXd inverse;     // parameters x parameters: of the normal matrix
    Eigen::MatrixXd covariance;  // parameters x parameters
};
/// `block_ends`: one past the last row of each block of data; rows beyond them, such as priors, do not vary.
Sandwich sandwich_of(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                     const std::vector<Eigen::Index>& block_ends);

/// Half widths of 95% intervals from fits that each left out one of several runs (Student's t); of fewer than
/// three it is zero.
Eigen::VectorXd jackknife_half_widths(const std::vector<Eigen::VectorXd>& without_a_run,
                                      Eigen::Index parameters);

/// Levenberg-Marquardt with the Jacobian by differences, from `start`.
LeastSquaresFit fit_least_squares(const ResidualFunction& residuals, const Eigen::VectorXd& start,
                                  const LeastSquaresOptions& options = {});
/// The same from parameters whose residuals and Jacobian are known. Steps are taken with this Jacobian as
/// long as they lower the sum about as far as promised.
LeastSquaresFit fit_least_squares(const ResidualFunction& residuals, LeastSquaresFit start,
                                  const LeastSquaresOptions& options);

}  // namespace capstan::gap
