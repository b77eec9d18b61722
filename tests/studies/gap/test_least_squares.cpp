#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "capstan/calibration/least_squares.h"

namespace capstan::gap {
namespace {

// A straight line through four points that it does not meet exactly.
struct Line {
    Eigen::MatrixXd design{{1.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}, {1.0, 3.0}};
    Eigen::VectorXd measured{{1.1, 2.9, 5.2, 6.8}};

    Eigen::MatrixXd operator()(const Eigen::MatrixXd& parameters) const {
        return (design * parameters).colwise() - measured;
    }
    Eigen::VectorXd solution() const { return design.colPivHouseholderQr().solve(measured); }
};

const Eigen::VectorXd far_away{{40.0, -30.0}};

TEST(LeastSquares, OneStepOfALinearProblemLeavesOnlyTheDamping) {
    LeastSquaresOptions one_step;
    one_step.max_iterations = 1;
    const LeastSquaresFit fit = fit_least_squares(Line(), far_away, one_step);
    EXPECT_LT((fit.parameters - Line().solution()).norm(), 1e-2 * far_away.norm());
}

TEST(LeastSquares, AConvergedLinearFitSolvesTheNormalEquations) {
    const LeastSquaresFit fit = fit_least_squares(Line(), far_away);
    EXPECT_TRUE(fit.converged);
    EXPECT_LT((fit.parameters - Line().solution()).norm(), 1e-6);
    EXPECT_NEAR(fit.sum_of_squares, Line()(Line().solution()).squaredNorm(), 1e-10);
}

// At 1 the derivative of the square is 2; a forward difference adds its step.
TEST(LeastSquares, CentralDifferencesAreExactForAParabolaAndForwardOnesOffByTheirStep) {
    const auto square = [](const Eigen::MatrixXd& parameters) -> Eigen::MatrixXd {
        return parameters.array().square();
    };
    LeastSquaresOptions only_the_jacobian;
    only_the_jacobian.max_iterations = 0;
    only_the_jacobian.difference_step = 0.05;
    const Eigen::VectorXd one{{1.0}};
    EXPECT_NEAR(fit_least_squares(square, one, only_the_jacobian).jacobian(0, 0), 2.0, 1e-12);
    only_the_jacobian.differences = Differences::forward;
    EXPECT_NEAR(fit_least_squares(square, one, only_the_jacobian).jacobian(0, 0), 2.05, 1e-12);
}

// The best slope is 1.9. With at least 2.5 the best line has that slope and goes through the mean point.
TEST(LeastSquares, AParameterStopsAtItsBoundAndTheOthersAreTheBestThatGoWithIt) {
    LeastSquaresOptions bounded;
    bounded.lower_bounds = Eigen::VectorXd{{-100.0, 2.5}};
    const LeastSquaresFit fit = fit_least_squares(Line(), far_away, bounded);
    EXPECT_EQ(fit.parameters[1], 2.5);
    EXPECT_NEAR(fit.parameters[0], Line().measured.mean() - 2.5 * 1.5, 1e-6);
}

TEST(LeastSquares, AParameterLeavesItsBoundWhenTheSumFallsInside) {
    LeastSquaresOptions bounded;
    bounded.lower_bounds = Eigen::VectorXd{{-100.0, 0.0}};
    const LeastSquaresFit fit = fit_least_squares(Line(), Eigen::VectorXd{{40.0, -3.0}}, bounded);
    EXPECT_LT((fit.parameters - Line().solution()).norm(), 1e-6);
}

TEST(LeastSquares, CountsEverySetOfParametersThatItEvaluates) {
    Eigen::Index evaluated = 0;
    const auto counting = [&](const Eigen::MatrixXd& parameters) {
        evaluated += parameters.cols();
        return Line()(parameters);
    };
    LeastSquaresOptions options;
    options.dampings_at_once = 3;
    EXPECT_EQ(fit_least_squares(counting, far_away, options).evaluations, evaluated);
}

// A decay with three parameters: amplitude, rate and rest.
Eigen::MatrixXd decay(const Eigen::MatrixXd& parameters) {
    constexpr Eigen::Index samples = 20;
    const auto value = [](const Eigen::VectorXd& of, double time) {
        return of[0] * std::exp(-of[1] * time) + of[2];
    };
    const Eigen::VectorXd truth{{2.0, 1.5, 0.3}};
    Eigen::MatrixXd residuals(samples, parameters.cols());
    for (Eigen::Index column = 0; column < parameters.cols(); ++column) {
        for (Eigen::Index sample = 0; sample < samples; ++sample) {
            const double time = 0.1 * static_cast<double>(sample);
            residuals(sample, column) = value(parameters.col(column), time) - value(truth, time);
        }
    }
    return residuals;
}

TEST(LeastSquares, AJacobianThatIsCorrectedAlongTheStepsLeadsToTheSameFitWithFewerEvaluations) {
    const Eigen::VectorXd start{{1.0, 0.8, 0.0}};
    LeastSquaresOptions options;
    options.jacobian_at_end = false;
    const LeastSquaresFit plain = fit_least_squares(decay, start, options);
    options.secant = true;
    const LeastSquaresFit corrected = fit_least_squares(decay, start, options);
    EXPECT_TRUE(corrected.converged);
    EXPECT_LT((corrected.parameters - plain.parameters).norm(), 1e-3);
    EXPECT_LT(corrected.evaluations, plain.evaluations);
}

TEST(LeastSquares, AKnownJacobianIsNotComputedAgain) {
    const Line line;
    LeastSquaresFit known;
    known.parameters = far_away;
    known.residuals = line(far_away);
    known.jacobian = line.design;
    LeastSquaresOptions options;
    options.max_iterations = 1;
    options.jacobian_at_end = false;
    const LeastSquaresFit fit = fit_least_squares(line, known, options);
    EXPECT_EQ(fit.evaluations, 1);
    EXPECT_LT((fit.parameters - line.solution()).norm(), 1e-2 * far_away.norm());
}

TEST(LeastSquares, ASearchDoesNotEndOnAJacobianFromElsewhere) {
    const Line line;
    LeastSquaresFit flat;
    flat.parameters = far_away;
    flat.residuals = line(far_away);
    flat.jacobian = Eigen::MatrixXd::Zero(line.design.rows(), line.design.cols());
    LeastSquaresOptions options;
    options.min_decrease = 1e-9;
    const LeastSquaresFit fit = fit_least_squares(line, flat, options);
    EXPECT_TRUE(fit.converged);
    EXPECT_LT((fit.parameters - line.solution()).norm(), 1e-3);
    EXPECT_LT((fit.jacobian - line.design).norm(), 1e-6 * line.design.norm());
}

// The first step leads uphill; a Jacobian at the start then leads down.
TEST(LeastSquares, AWrongJacobianAtTheStartIsReplaced) {
    const Line line;
    LeastSquaresFit wrong;
    wrong.parameters = far_away;
    wrong.residuals = line(far_away);
    wrong.jacobian = -line.design;
    const LeastSquaresFit fit = fit_least_squares(line, wrong, {});
    EXPECT_LT((fit.parameters - line.solution()).norm(), 1e-6);
}

// From 3 the undamped step leads to a negative argument of the logarithm.
TEST(LeastSquares, AStepToResidualsThatAreNotFiniteIsShortened) {
    const auto logarithm = [](const Eigen::MatrixXd& parameters) -> Eigen::MatrixXd {
        return parameters.array().log();
    };
    const LeastSquaresFit fit = fit_least_squares(logarithm, Eigen::VectorXd{{3.0}});
    EXPECT_TRUE(fit.converged);
    EXPECT_NEAR(fit.parameters[0], 1.0, 1e-4);
}

TEST(LeastSquares, AParameterWithoutEffectStaysWhereItStarts) {
    const auto first_only = [](const Eigen::MatrixXd& parameters) -> Eigen::MatrixXd {
        return parameters.topRows(1).array() - 2.0;
    };
    const LeastSquaresFit fit = fit_least_squares(first_only, Eigen::VectorXd{{0.0, 7.0}});
    EXPECT_NEAR(fit.parameters[0], 2.0, 1e-6);
    EXPECT_EQ(fit.parameters[1], 7.0);
}

TEST(LeastSquares, SeveralDampingsAtOnceReachTheSameMinimum) {
    LeastSquaresOptions side_by_side;
    side_by_side.dampings_at_once = 4;
    const LeastSquaresFit fit = fit_least_squares(Line(), far_away, side_by_side);
    EXPECT_LT((fit.parameters - Line().solution()).norm(), 1e-6);
}

// A valley that is as flat as x^4 is walked down for ever; whoever needs the sum only to within a thousandth
// stops early.
TEST(LeastSquares, ASearchEndsWhereFurtherStepsAreWorthLittle) {
    const auto flat = [](const Eigen::MatrixXd& parameters) -> Eigen::MatrixXd {
        return parameters.array().square();
    };
    LeastSquaresOptions options;
    options.parameter_tolerance = 0.0;
    const LeastSquaresFit patient = fit_least_squares(flat, Eigen::VectorXd{{2.0}}, options);
    options.min_decrease = 1e-3;
    const LeastSquaresFit brief = fit_least_squares(flat, Eigen::VectorXd{{2.0}}, options);
    EXPECT_TRUE(brief.converged);
    EXPECT_LT(brief.evaluations, patient.evaluations / 2);
    EXPECT_LT(brief.sum_of_squares, 10.0 * options.min_decrease);
}

// The second residual is 10 whatever the parameter, so no search ends below a sum of 100.
TEST(LeastSquares, ASearchThatCannotReachTheGoalIsGivenUp) {
    const auto with_a_floor = [](const Eigen::MatrixXd& parameters) {
        Eigen::MatrixXd residuals(2, parameters.cols());
        residuals << parameters, Eigen::MatrixXd::Constant(1, parameters.cols(), 10.0);
        return residuals;
    };
    LeastSquaresOptions options;
    options.pruned_sum_of_squares = 50.0;
    EXPECT_FALSE(fit_least_squares(with_a_floor, Eigen::VectorXd{{100.0}}, options).converged);
    options.pruned_sum_of_squares = 200.0;
    EXPECT_TRUE(fit_least_squares(with_a_floor, Eigen::VectorXd{{100.0}}, options).converged);
}

}  // namespace
}  // namespace capstan::gap
