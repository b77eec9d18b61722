#pragma once

#include <span>
#include <vector>

#include "capstan/estimation/estimation_problem.h"
#include "capstan/sensing/noise.h"

namespace capstan {

/// Where to look along the curve: what the distal end may have done since the previous state.
struct DistalMotionPrior {
    double largest_increment_m = 0.0;  ///< flat between minus and plus this
    int points = 256;                  ///< of the grid; a multiple of 8
};

/// All states that the previous state and the proximal displacement allow (E10). One number is unknown, the
/// distal end's displacement; each of its values gives one state through the closed-form step. Sampled on an
/// even grid, so that every point has the same prior weight; points where the cable is slack say nothing
/// about direction and stay in.
class FeasibleCurve {
  public:
    FeasibleCurve(const EstimationProblem& problem, const DistalMotionPrior& prior);

    int points() const { return points_; }
    int nodes() const { return static_cast<int>(tension_N_.size()) / points_; }
    /// Tension of a node along the curve [N].
    std::span<const double> tension_N(int node) const {  // points
        return std::span<const double>(tension_N_).subspan(static_cast<std::size_t>(node) * points_, points_);
    }
    std::span<const double> distal_displacement_m() const { return distal_displacement_m_; }  // points

  private:
    int points_;
    std::vector<double> distal_displacement_m_;  // points
    std::vector<double> tension_N_;              // nodes x points
};

/// How likely a reading is at each point of a curve, for one noise level.
class CurveLikelihood {
  public:
    CurveLikelihood(const FeasibleCurve& curve, const NoiseLevel& noise);

    /// Log likelihood of reading `reading_N` at node `sensor`, less a constant; E11. A reading at the end of
    /// the sensor's range only says that the noisy tension is at least that.
    void log_likelihood(int sensor, double reading_N, std::span<double> result) const;  // points

  private:
    int points_;
    double range_N_;
    std::vector<double> precision_per_N_;  // nodes x points: 1 / deviation
    std::vector<double> scaled_tension_;   // nodes x points: tension / deviation
    std::vector<double> log_deviation_;    // nodes x points
};

/// The sum of log likelihoods of several sensors' readings, each already evaluated along the curve.
void add_log_likelihoods(std::span<const double> per_sensor,  // sensors x points, all nodes
                         std::span<const int> sensors, std::span<double> result);

/// The same for one sensor more: its reading's log likelihood added to that of the others. All are points
/// long, a multiple of 8.
void add_log_likelihood(std::span<const double> before, std::span<const double> sensor,
                        std::span<double> result);

/// The first point at which the log likelihood is largest; points are a multiple of 8.
int likeliest_point(std::span<const double> log_likelihood);

/// Mean of the curve under weights exp(log_likelihood), flat prior. `log_likelihood` is overwritten.
void posterior_mean(const FeasibleCurve& curve, std::span<double> log_likelihood,
                    std::span<double> tension_N);

/// The curve where the log likelihood is largest, between grid points by a parabola through the three around
/// it.
void maximum_likelihood(const FeasibleCurve& curve, std::span<const double> log_likelihood,
                        std::span<double> tension_N);

}  // namespace capstan
