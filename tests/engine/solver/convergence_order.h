#pragma once

#include <cmath>
#include <iostream>
#include <vector>

#include "capstan/cable/cable_state.h"

namespace capstan::test {

/// Errors of one quantity, each from a discretization twice as fine as the one before.
class ErrorsByHalving {
  public:
    void add(double error) { errors_.push_back(error); }

    /// Powers of two gained by each halving.
    std::vector<double> orders() const {
        std::vector<double> orders;
        for (std::size_t k = 1; k < errors_.size(); ++k) {
            orders.push_back(std::log2(errors_[k - 1] / errors_[k]));
        }
        return orders;
    }
    double coarsest() const { return errors_.front(); }
    double finest() const { return errors_.back(); }
    /// Single orders jump with where a turning point or a front falls between samples; their mean tells.
    double mean_order() const {
        return std::log2(errors_.front() / errors_.back()) / static_cast<double>(errors_.size() - 1);
    }
    void tell(const char* what) const {
        std::cout << "    " << what << ": errors";
        for (const double error : errors_) std::cout << ' ' << error;
        std::cout << "; order of each halving";
        for (const double order : orders()) std::cout << ' ' << std::round(100.0 * order) / 100.0;
        std::cout << "; mean " << mean_order() << "\n";
    }

  private:
    std::vector<double> errors_;
};

/// Mean over instants and nodes of the difference in tension. `fine_nodes_per_node` is how many segments of
/// `fine` make one of `coarse`.
inline double mean_difference_N(const std::vector<CableState>& coarse, const std::vector<CableState>& fine,
                                std::size_t fine_nodes_per_node = 1) {
    double sum_N = 0.0;
    const std::size_t nodes = coarse.front().tension_N.size();
    for (std::size_t instant = 0; instant < coarse.size(); ++instant) {
        for (std::size_t node = 0; node < nodes; ++node) {
            sum_N += std::abs(coarse[instant].tension_N[node] -
                              fine[instant].tension_N[node * fine_nodes_per_node]);
        }
    }
    return sum_N / static_cast<double>(coarse.size() * nodes);
}

}  // namespace capstan::test
