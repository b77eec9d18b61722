#include "capstan/estimation/information_bound.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace capstan {

namespace {

// Fisher information of one reading about the logarithm of its tension: from its mean and from its deviation,
// sigma^2 = (ratio T)^2 + constant, so that d ln sigma / d ln T = (ratio T / sigma)^2.
double log_tension_information(const NoiseLevel& noise, double tension_N) {
    const double deviation_N = reading_deviation_N(noise, tension_N);
    if (deviation_N == 0.0) return std::numeric_limits<double>::infinity();  // the reading is the tension
    const double slope = tension_N / deviation_N;
    const double fraction = noise.multiplicative_ratio * tension_N / deviation_N;
    return slope * slope + 2.0 * fraction * fraction * fraction * fraction;
}

}  // namespace

double known_direction_bound_N(std::span<const std::optional<SensorBranch>> branch,
                               std::span<const double> true_tension_N, std::span<const int> sensors,
                               const NoiseLevel& noise) {
    double information = 0.0;
    double moving_tension_N = 0.0;  // summed over the nodes that the scale moves
    for (const int sensor : sensors) {
        if (!branch[sensor]) continue;
        information += log_tension_information(noise, true_tension_N[sensor]);
        moving_tension_N = 0.0;
        for (std::size_t node = 0; node < true_tension_N.size(); ++node) {
            moving_tension_N += branch[sensor]->slope[node] * true_tension_N[sensor];
        }
    }
    if (information == 0.0) return std::numeric_limits<double>::infinity();
    const double mean_moving_tension_N = moving_tension_N / static_cast<double>(true_tension_N.size());
    return std::sqrt(2.0 / std::numbers::pi) * mean_moving_tension_N / std::sqrt(information);
}

}  // namespace capstan
