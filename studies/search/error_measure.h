#pragma once

#include <cmath>
#include <span>

namespace capstan {

/// How the errors of an estimate become the numbers that are summed up over repetitions.
struct ErrorMeasure {
    std::span<const double> truth_N;   // nodes
    std::span<const double> fraction;  // at least nodes: weights that sum to one
    int width = 1;                     ///< 1: the weighted mean; nodes: each node's absolute error

    /// Writes `width` numbers [N]; tension(node) is the estimate.
    template <class Tension>
    void write(const Tension& tension, double* error_N) const {
        const int nodes = static_cast<int>(truth_N.size());
        if (width > 1) {
            for (int node = 0; node < nodes; ++node) error_N[node] = std::abs(tension(node) - truth_N[node]);
            return;
        }
        // Four sums, so that an addition need not wait for the one before.
        double sum_N[4] = {0.0, 0.0, 0.0, 0.0};
        int node = 0;
        for (; node + 4 <= nodes; node += 4) {
            for (int lane = 0; lane < 4; ++lane) {
                sum_N[lane] += fraction[node + lane] * std::abs(tension(node + lane) - truth_N[node + lane]);
            }
        }
        for (; node < nodes; ++node) sum_N[0] += fraction[node] * std::abs(tension(node) - truth_N[node]);
        error_N[0] = (sum_N[0] + sum_N[1]) + (sum_N[2] + sum_N[3]);
    }
};

}  // namespace capstan
