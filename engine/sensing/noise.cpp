#include "capstan/sensing/noise.h"

#include <cmath>

#include "capstan/sensing/random_stream.h"

namespace capstan {

double reading_deviation_N(const NoiseLevel& noise, double tension_N) {
    const double multiplicative_N = noise.multiplicative_ratio * tension_N;
    return std::sqrt(multiplicative_N * multiplicative_N + noise.additive_N * noise.additive_N +
                     noise.bias_N * noise.bias_N);
}

ReadingDraws draw_readings(const DrawAddress& address, int nodes) {
    ReadingDraws draws;
    draws.multiplicative.reserve(nodes);
    draws.additive.reserve(nodes);
    draws.bias.reserve(nodes);
    for (int node = 0; node < nodes; ++node) {
        const auto number = static_cast<std::uint32_t>(node);
        const auto fresh = standard_normals(
            {address.seed, RandomPurpose::reading_noise, address.scenario, address.repetition, number});
        const auto lasting =
            standard_normals({address.seed, RandomPurpose::sensor_bias, 0, address.repetition, number});
        draws.multiplicative.push_back(fresh[0]);
        draws.additive.push_back(fresh[1]);
        draws.bias.push_back(lasting[0]);
    }
    return draws;
}

void read_tensions(const NoiseLevel& noise, const ReadingDraws& draws, std::span<const double> tension_N,
                   std::span<double> reading_N) {
    for (std::size_t node = 0; node < tension_N.size(); ++node) {
        reading_N[node] = tension_N[node] * (1.0 + noise.multiplicative_ratio * draws.multiplicative[node]) +
                          noise.additive_N * draws.additive[node] + noise.bias_N * draws.bias[node];
    }
}

}  // namespace capstan
