#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace capstan {

/// The error of a tension sensor (E9), as its data sheet says: reading = T (1 + multiplicative_ratio e1) +
/// additive_N e2 + bias_N e3, all e standard normal; e3 belongs to the sensor and is the same at every
/// instant of a repetition. The reading is then rounded to multiples of the step of the converter and ends at the
/// range.
struct NoiseLevel {
    double multiplicative_ratio = 0.0;
    double additive_N = 0.0;
    double bias_N = 0.0;
    double quantisation_N = 0.0;  ///< step of the converter; 0: none
    double range_N = 1e9;         ///< the largest reading; by default more than any tension
};

/// Standard deviation [N] of a reading where the true tension is `tension_N`, well inside the range.
double reading_deviation_N(const NoiseLevel& noise, double tension_N);

/// Which draw of a study: everything of a random address but the node.
struct DrawAddress {
    std::uint64_t seed = 0;
    std::uint32_t scenario = 0;
    std::uint32_t repetition = 0;
};

/// The standard normal numbers behind the readings of all nodes; noise levels share them, so that differences
/// between noise levels, layouts and methods are paired.
struct ReadingDraws {
    std::vector<double> multiplicative;  // nodes
    std::vector<double> additive;        // nodes
    std::vector<double> bias;            // nodes
};

/// All draws; with `for_noise` those that this noise has no use for are left out, at 0.
ReadingDraws draw_readings(const DrawAddress& address, int nodes,
                           const NoiseLevel& for_noise = {1.0, 1.0, 1.0});

/// One reading per node [N].
void read_tensions(const NoiseLevel& noise, const ReadingDraws& draws, std::span<const double> tension_N,
                   std::span<double> reading_N);

}  // namespace capstan
