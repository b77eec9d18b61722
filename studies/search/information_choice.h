#pragma once

#include <vector>

#include "capstan/placement/prepared_study.h"

namespace capstan {

/// The information that the readings of a sensor set are expected to carry about the state: half the log
/// determinant of I + D^-1/2 C D^-1/2, where C is the covariance of the sensors' tensions along the feasible
/// curve (its flat prior) and D the variance of their noise at the mean tension. The classical D-optimal
/// choice, and the mutual information if both were Gaussian.
class SetInformation {
  public:
    SetInformation(const PreparedScenario& scenario, const NoiseLevel& noise);

    double nats(const std::vector<int>& nodes) const;  ///< nodes from 0

    int nodes() const { return nodes_; }
    /// Of D^-1/2 C D^-1/2.
    double scaled_covariance(int node, int other) const { return scaled_covariance_[node * nodes_ + other]; }

  private:
    int nodes_;
    std::vector<double> scaled_covariance_;  // nodes x nodes: D^-1/2 C D^-1/2
};

}  // namespace capstan
