#include "capstan/search/information_choice.h"

#include <algorithm>
#include <cmath>

namespace capstan {

namespace {

// A noiseless sensor's variance would be zero, its information infinite.
constexpr double smallest_deviation_N = 1e-6;

}  // namespace

SetInformation::SetInformation(const PreparedScenario& scenario, const NoiseLevel& noise)
    : nodes_(scenario.curve.nodes()), scaled_covariance_(static_cast<std::size_t>(nodes_) * nodes_) {
    const int points = scenario.curve.points();
    std::vector<double> mean_N(nodes_, 0.0);
    std::vector<double> deviation_N(nodes_);
    for (int node = 0; node < nodes_; ++node) {
        for (const double tension_N : scenario.curve.tension_N(node)) mean_N[node] += tension_N / points;
        deviation_N[node] = std::max(reading_deviation_N(noise, mean_N[node]), smallest_deviation_N);
    }
    for (int a = 0; a < nodes_; ++a) {
        for (int b = 0; b < nodes_; ++b) {
            const auto along_a = scenario.curve.tension_N(a);
            const auto along_b = scenario.curve.tension_N(b);
            double sum_N2 = 0.0;
            for (int k = 0; k < points; ++k) sum_N2 += (along_a[k] - mean_N[a]) * (along_b[k] - mean_N[b]);
            scaled_covariance_[a * nodes_ + b] = sum_N2 / points / (deviation_N[a] * deviation_N[b]);
        }
    }
}

// The determinant by Cholesky, row after row: the matrix is at least the identity, so no pivot vanishes.
double SetInformation::nats(const std::vector<int>& nodes) const {
    const std::size_t size = nodes.size();
    std::vector<double> lower(size * size, 0.0);
    double log_determinant = 0.0;
    for (std::size_t row = 0; row < size; ++row) {
        for (std::size_t column = 0; column <= row; ++column) {
            double value =
                scaled_covariance_[nodes[row] * nodes_ + nodes[column]] + (row == column ? 1.0 : 0.0);
            for (std::size_t k = 0; k < column; ++k)
                value -= lower[row * size + k] * lower[column * size + k];
            lower[row * size + column] =
                row == column ? std::sqrt(value) : value / lower[column * size + column];
        }
        log_determinant += 2.0 * std::log(lower[row * size + row]);
    }
    return 0.5 * log_determinant;
}

}  // namespace capstan
