#include "capstan/ensemble/ensemble_draws.h"

#include <cmath>

#include "capstan/sensing/random_stream.h"

namespace capstan {

namespace {

// Torques and the load's position tell the difference of a pair's tensions and nothing of their sum, but a
// correlation by chance with the sum corrects it at every sample, so that it counts as that of half as many
// members. A tension sensor tells of the sum, and the stronger screening would then cost accuracy.
constexpr double chance_without_sum = 2.0;

// Exactly as many as the members, without the chance in their mean and variance.
void standardise(std::span<double> row) {
    const double count = static_cast<double>(row.size());
    double sum = 0.0;
    for (const double each : row) sum += each;
    double squares = 0.0;
    for (double& each : row) {
        each -= sum / count;
        squares += each * each;
    }
    const double scale = std::sqrt((count - 1.0) / squares);
    for (double& each : row) each *= scale;
}

}  // namespace

EnsembleDraws::EnsembleDraws(const EnsembleAddress& address, int members, int parameters, int sensors,
                             int samples)
    : members_(members),
      samples_(samples),
      expected_(members, 1.0),
      expected_without_sum_(members, chance_without_sum) {
    const auto count = static_cast<std::size_t>(members);
    const auto at = [&](RandomPurpose purpose, std::size_t scenario, std::size_t node) {
        return standard_normals({address.seed, purpose, static_cast<std::uint32_t>(scenario), address.world,
                                 static_cast<std::uint32_t>(node)});
    };
    parameters_.resize(static_cast<std::size_t>(parameters) * count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(parameters); ++k) {
        for (std::size_t j = 0; j < count; ++j)
            parameters_[k * count + j] = at(RandomPurpose::member_cable, j, k)[0];
        standardise(std::span(parameters_).subspan(k * count, count));
    }
    const auto fill_pairs = [&](std::vector<double>& rows, int pairs, RandomPurpose purpose,
                                bool member_is_scenario) {
        rows.resize(2 * static_cast<std::size_t>(pairs) * count);
        for (std::size_t k = 0; k < static_cast<std::size_t>(pairs); ++k) {
            for (std::size_t j = 0; j < count; ++j) {
                const auto normals = member_is_scenario ? at(purpose, j, k) : at(purpose, k, j);
                rows[2 * k * count + j] = normals[0];
                rows[(2 * k + 1) * count + j] = normals[1];
            }
            standardise(std::span(rows).subspan(2 * k * count, count));
            standardise(std::span(rows).subspan((2 * k + 1) * count, count));
        }
    };
    fill_pairs(sensors_, sensors, RandomPurpose::member_sensor, true);
    fill_pairs(far_end_, samples, RandomPurpose::member_far_end, false);
}

std::vector<double> spread(double centre, double deviation, std::span<const double> normals) {
    std::vector<double> row(normals.begin(), normals.end());
    for (double& each : row) each = centre + deviation * each;
    return row;
}

}  // namespace capstan
