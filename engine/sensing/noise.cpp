#include "capstan/sensing/noise.h"

#include <algorithm>
#include <cmath>

#include "capstan/sensing/random_stream.h"

namespace capstan {

double reading_deviation_N(const NoiseLevel& noise, double tension_N) {
    const double multiplicative_N = noise.multiplicative_ratio * tension_N;
    // The rounding error is uniform over a step, which has a variance of a twelfth of its square.
    return std::sqrt(multiplicative_N * multiplicative_N + noise.additive_N * noise.additive_N +
                     noise.bias_N * noise.bias_N + noise.quantisation_N * noise.quantisation_N / 12.0);
}

ReadingDraws draw_readings(const DrawAddress& address, int nodes, const NoiseLevel& for_noise) {
    ReadingDraws draws;
    draws.multiplicative.assign(nodes, 0.0);
    draws.additive.assign(nodes, 0.0);
    draws.bias.assign(nodes, 0.0);
    for (int node = 0; node < nodes; ++node) {
        const auto number = static_cast<std::uint32_t>(node);
        if (for_noise.multiplicative_ratio != 0.0 || for_noise.additive_N != 0.0) {
            const auto normals = standard_normals(
                {address.seed, RandomPurpose::reading_noise, address.scenario, address.repetition, number});
            draws.multiplicative[node] = normals[0];
            draws.additive[node] = normals[1];
        }
        if (for_noise.bias_N != 0.0) {
            draws.bias[node] = standard_normals(
                {address.seed, RandomPurpose::sensor_bias, 0, address.repetition, number})[0];
        }
    }
    return draws;
}

void read_tensions(const NoiseLevel& noise, const ReadingDraws& draws, std::span<const double> tension_N,
                   std::span<double> reading_N) {
    for (std::size_t node = 0; node < tension_N.size(); ++node) {
        reading_N[node] = tension_N[node] * (1.0 + noise.multiplicative_ratio * draws.multiplicative[node]) +
                          noise.additive_N * draws.additive[node] + noise.bias_N * draws.bias[node];
        if (noise.quantisation_N > 0.0) {
            reading_N[node] = noise.quantisation_N * std::round(reading_N[node] / noise.quantisation_N);
        }
        reading_N[node] = std::min(reading_N[node], noise.range_N);
    }
}

}  // namespace capstan
