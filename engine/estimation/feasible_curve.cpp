#include "capstan/estimation/feasible_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/curve_peak.h"
#include "capstan/estimation/tension_reading.h"

namespace capstan {

namespace {

// Where a saturated reading is next to impossible its likelihood is still no zero.
constexpr double smallest_probability = 1e-300;

}  // namespace

FeasibleCurve::FeasibleCurve(const EstimationProblem& problem, const DistalMotionPrior& prior)
    : points_(prior.points) {
    if (prior.points < 8 || prior.points % 8 != 0 || !(prior.largest_increment_m > 0.0)) {
        throw InvalidInput({"feasible curve: " + std::to_string(prior.points) + " points over +-" +
                            std::to_string(prior.largest_increment_m) +
                            " m; points must be a multiple of 8 and the range above 0"});
    }
    const int node_count = problem.model.cable().nodes();
    const double before_m = problem.previous.displacement_m.back();
    tension_N_.resize(static_cast<std::size_t>(node_count) * points_);
    for (int k = 0; k < points_; ++k) {
        const double fraction = 2.0 * (k + 0.5) / points_ - 1.0;  // cell centres of (-1, 1)
        const double distal_m = before_m + fraction * prior.largest_increment_m;
        distal_displacement_m_.push_back(distal_m);
        CableState state = problem.previous;
        problem.model.advance(state, {EndCondition::position_m(problem.proximal_displacement_m),
                                      EndCondition::position_m(distal_m)});
        for (int node = 0; node < node_count; ++node) {
            tension_N_[static_cast<std::size_t>(node) * points_ + k] = state.tension_N[node];
        }
    }
}

CurveLikelihood::CurveLikelihood(const FeasibleCurve& curve, const NoiseLevel& noise)
    : points_(curve.points()), range_N_(noise.range_N) {
    for (int node = 0; node < curve.nodes(); ++node) {
        for (const double tension_N : curve.tension_N(node)) {
            const double deviation_N = std::max(reading_deviation_N(noise, tension_N), smallest_deviation_N);
            precision_per_N_.push_back(1.0 / deviation_N);
            scaled_tension_.push_back(tension_N / deviation_N);
            log_deviation_.push_back(std::log(deviation_N));
        }
    }
}

void CurveLikelihood::log_likelihood(int sensor, double reading_N, std::span<double> result) const {
    const std::size_t start = static_cast<std::size_t>(sensor) * points_;
    const double* precision = precision_per_N_.data() + start;
    const double* scaled = scaled_tension_.data() + start;
    const double* log_deviation = log_deviation_.data() + start;
    if (reading_N >= range_N_) {
        for (int k = 0; k < points_; ++k) {
            const double residual = range_N_ * precision[k] - scaled[k];
            const double beyond = 0.5 * std::erfc(residual * std::numbers::sqrt2 / 2.0);
            result[k] = std::log(std::max(beyond, smallest_probability));
        }
        return;
    }
    for (int k = 0; k < points_; ++k) {
        const double residual = reading_N * precision[k] - scaled[k];
        result[k] = -0.5 * residual * residual - log_deviation[k];
    }
}

void add_log_likelihoods(std::span<const double> per_sensor, std::span<const int> sensors,
                         std::span<double> result) {
    const std::size_t points = result.size();
    std::fill(result.begin(), result.end(), 0.0);
    for (const int sensor : sensors) {
        const double* row = per_sensor.data() + static_cast<std::size_t>(sensor) * points;
        for (std::size_t k = 0; k < points; ++k) result[k] += row[k];
    }
}

void maximum_likelihood(const FeasibleCurve& curve, std::span<const double> log_likelihood,
                        std::span<double> tension_N) {
    maximum_likelihood_around(curve, log_likelihood, likeliest_point(log_likelihood), tension_N);
}

CurvePlace likeliest_place(std::span<const double> log_likelihood, int best) {
    const int last = static_cast<int>(log_likelihood.size()) - 1;
    double offset = 0.0;  // in grid steps from `best`
    if (best > 0 && best < last) {
        const double left = log_likelihood[best - 1] - log_likelihood[best];
        const double right = log_likelihood[best + 1] - log_likelihood[best];
        if (left + right < 0.0) offset = 0.5 * (left - right) / (left + right);
    }
    return {best, offset < 0.0 ? std::max(best - 1, 0) : std::min(best + 1, last), std::abs(offset)};
}

void maximum_likelihood_around(const FeasibleCurve& curve, std::span<const double> log_likelihood, int best,
                               std::span<double> tension_N) {
    const CurvePlace place = likeliest_place(log_likelihood, best);
    for (int node = 0; node < curve.nodes(); ++node) {
        const auto along = curve.tension_N(node);
        tension_N[node] = along[best] + place.fraction * (along[place.neighbour] - along[best]);
    }
}

}  // namespace capstan
