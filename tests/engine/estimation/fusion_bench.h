#pragma once
// Everything that fusing needs, for one instant and one set of readings.

#include <algorithm>
#include <span>
#include <vector>

#include "capstan/estimation/fusion_method.h"
#include "capstan/estimation/single_sensor.h"
#include "paper_experiment.h"

namespace capstan::test {

/// How far the distal end may have gone in a sample, in the paper's configuration.
inline constexpr double distal_reach_m = 0.00063;

class FusionBench {
  public:
    FusionBench(const Instant& instant, const std::vector<double>& reading_N, const NoiseLevel& noise,
                int points = 128)
        : nodes_(instant.nodes()),
          curve_(instant.problem(), {distal_reach_m, points}),
          unknown_N_(nodes_ * padded_nodes(nodes_)),
          known_N_(unknown_N_.size()),
          directions_(nodes_),
          verified_(nodes_),
          known_usable_(nodes_),
          weight_(nodes_),
          per_sensor_(nodes_ * points) {
        const SingleSensorEstimator estimator(instant.problem(), DistalSide::excluded);
        const CurveLikelihood likelihood(curve_, noise);
        for (int i = 0; i < nodes_; ++i) {
            const SensorBranch& branch = estimator.branches(i)[estimator.choose(i, reading_N[i]).branch];
            directions_[i] = branch.directions;
            verified_[i] = branch.verified;
            const auto known = known_direction_branch(instant.problem(), instant.truth.last_motion, i);
            known_usable_[i] = known.has_value();
            for (int j = 0; j < nodes_; ++j) {
                const int place = i * padded_nodes(nodes_) + j;
                unknown_N_[place] = branch.tension_N(j, reading_N[i]);
                known_N_[place] = known ? known->tension_N(j, reading_N[i]) : instant.previous.tension_N[j];
            }
            weight_[i] = 1.0 + 0.3 * i;
            likelihood.log_likelihood(i, reading_N[i], std::span(per_sensor_).subspan(i * points, points));
        }
    }

    std::vector<double> fuse(const FusionMethod& method, const std::vector<int>& sensors) const {
        std::vector<double> log_likelihood = log_likelihood_of(sensors);
        const SensorVote vote = take_vote(unknown(), sensors);
        const FusionInput input{
            sensors,       {nodes_, known_N_, {}, known_usable_}, unknown(), weight_, &vote, &curve_,
            log_likelihood};
        std::vector<double> tension_N(nodes_, std::nan(""));
        method.fuse(input, tension_N);
        return tension_N;
    }

    std::vector<double> log_likelihood_of(const std::vector<int>& sensors) const {
        std::vector<double> sum(curve_.points());
        add_log_likelihoods(per_sensor_, sensors, sum);
        return sum;
    }

    const FeasibleCurve& curve() const { return curve_; }

  private:
    SensorEstimates unknown() const { return {nodes_, unknown_N_, directions_, verified_}; }

    int nodes_;
    FeasibleCurve curve_;
    std::vector<double> unknown_N_;  // sensors x padded nodes
    std::vector<double> known_N_;    // sensors x padded nodes
    std::vector<DirectionBits> directions_;
    std::vector<std::uint8_t> verified_;
    std::vector<std::uint8_t> known_usable_;
    std::vector<double> weight_;
    std::vector<double> per_sensor_;  // sensors x points
};

}  // namespace capstan::test
