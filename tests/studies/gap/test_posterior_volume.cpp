// How much of the prior the numbers of a fit keep (E57), beside a sum over random draws of the numbers.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "capstan/gap/cause_fit.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

constexpr double log_two_decades = 4.605170185988092;

// The logarithm of a normalised density.
double log_normal(double deviation, double std) {
    return -0.5 * std::pow(deviation / std, 2) - std::log(std * std::sqrt(2.0 * std::numbers::pi));
}

// Of the bench's numbers, then of the cause's: of a size log-uniform over two decades.
double log_prior(const CandidateCause& cause, const Eigen::VectorXd& coordinates) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < nominal_coordinates; ++k)
        sum += log_normal(coordinates[k], std::max(nominal_log_std, cause.nominal_std(k)));
    for (std::size_t k = 0; k < cause.numbers.size(); ++k) {
        const double coordinate = coordinates[nominal_coordinates + static_cast<Eigen::Index>(k)];
        if (cause.numbers[k].kind == OpenNumber::Kind::size) {
            if (coordinate <= 0.0) return -std::numeric_limits<double>::infinity();
            sum -= std::log(coordinate * log_two_decades);
        } else {
            sum += log_normal(coordinate, cause.numbers[k].prior_std());
        }
    }
    return sum;
}

// As a diagnosis has it: on a coarser cut fronts make the likelihood rougher than a normal density is.
constexpr EffectsTwinOptions twin_options{.segments = 40, .stride = 1};

struct Volumes {
    double laplace = 0.0;
    double sampled = 0.0;
};

// Logarithms of the integral of likelihood and prior, with the best fit's likelihood as unit.
Volumes volumes_of(const std::string& effect, const BenchNumbers& truth, const Eigen::VectorXd& start) {
    const Recording recording = exact_session(truth, twin_options);
    const CauseFitter fitter(recording, twin_options, 1);
    const std::vector<CandidateCause> causes = candidate_causes(recording);
    const auto cause = std::find_if(causes.begin(), causes.end(),
                                    [&](const CandidateCause& each) { return each.effect == effect; });
    Eigen::VectorXd from = Eigen::VectorXd::Zero(nominal_coordinates + start.size());
    from.tail(start.size()) = start;
    const CauseFit fit = fitter.fit({{&*cause}, from}, {});

    const double independent = fitter.independent_samples() / fitter.determined_rows();
    const auto data = [&](const Eigen::MatrixXd& coordinates) {
        std::vector<Hypothesis> hypotheses;
        for (Eigen::Index k = 0; k < coordinates.cols(); ++k)
            hypotheses.push_back({fit.causes, coordinates.col(k), fit.bench});
        return fitter.data_residuals(hypotheses);
    };
    const Eigen::VectorXd here = data(fit.coordinates);
    const Eigen::MatrixXd jacobian = jacobian_at(data, fit.coordinates, here);
    Eigen::MatrixXd information = independent * jacobian.transpose() * jacobian;
    information.diagonal().array() += 1.0;  // no direction of the draws is wider than about a prior
    for (Eigen::Index k = 0; k < nominal_coordinates; ++k)
        information(k, k) += std::pow(std::max(nominal_log_std, cause->nominal_std(k)), -2);

    constexpr int draws = 4000;
    // Than a normal posterior. With 1.2 few draws meet the tails of a skewed one, and scatter by 0.3.
    constexpr double wider = 2.2;
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd drawn(fit.coordinates.size(), draws);
    Eigen::VectorXd log_density(draws);
    const double log_determinant = factor.matrixLLT().diagonal().array().log().sum();
    for (int k = 0; k < draws; ++k) {
        Eigen::VectorXd standard(fit.coordinates.size());
        for (double& each : standard) each = normal(random);
        drawn.col(k) = fit.coordinates + wider * factor.matrixU().solve(standard);
        log_density[k] =
            log_determinant -
            static_cast<double>(standard.size()) * std::log(wider * std::sqrt(2.0 * std::numbers::pi)) -
            0.5 * standard.squaredNorm();
    }
    const Eigen::MatrixXd residuals = data(drawn);
    double sum = 0.0;
    for (int k = 0; k < draws; ++k) {
        const double log_likelihood =
            -0.5 * independent * (residuals.col(k).squaredNorm() - here.squaredNorm());
        sum += std::exp(log_likelihood + log_prior(*cause, drawn.col(k)) - log_density[k]);
    }
    return {fit.log_volume_ratio - fitter.nominal_penalty(fit) - fitter.shape_penalty(fit),
            std::log(sum / draws)};
}

// Both agree to a factor of two in a probability. The rest is the scatter of the draws, about 0.15, and the
// skewness that a normal density lacks.
const double tolerance = std::log(2.0);

TEST(PosteriorVolume, AgreesWithDrawsWhereOneSizeIsFitted) {
    BenchNumbers truth;
    truth.effects.of<ViscousFriction>().drag_N_s_per_m2 = 2.0;
    const Volumes volumes = volumes_of("viscous_friction", truth, Eigen::VectorXd::Constant(1, 1.0));
    EXPECT_LT(volumes.sampled, -2.0);  // the recording tells something
    EXPECT_NEAR(volumes.laplace, volumes.sampled, tolerance);
}

TEST(PosteriorVolume, AgreesWithDrawsWhereASizeAndAShapeAreFitted) {
    BenchNumbers truth;
    truth.effects.of<NonlinearStiffness>() = {.toe_strain = 2e-3, .toe_tension_N = 20.0};
    const Volumes volumes =
        volumes_of("cable_stiffness_nonlinear", truth, Eigen::Vector2d(2.0, std::log(2.0)));
    EXPECT_LT(volumes.sampled, -4.0);
    EXPECT_NEAR(volumes.laplace, volumes.sampled, tolerance);
}

}  // namespace
}  // namespace capstan::gap
