#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capstan/ensemble/ensemble_rows.h"

namespace capstan {

/// Whose draws: estimators of one world share them, so that the differences between sensors are paired.
struct EnsembleAddress {
    std::uint64_t seed = 1;
    std::uint32_t world = 0;
};

/// The standard normal numbers of an ensemble, each row with mean 0 and variance 1 over the members; and the
/// tables that follow from how many they are.
class EnsembleDraws {
  public:
    EnsembleDraws(const EnsembleAddress& address, int members, int parameters, int sensors, int samples);

    int members() const { return members_; }
    int samples() const { return samples_; }
    std::span<const double> parameter(int which) const { return row(parameters_, which); }    ///< members
    std::span<const double> zero(int sensor) const { return row(sensors_, 2 * sensor); }      ///< members
    std::span<const double> gain(int sensor) const { return row(sensors_, 2 * sensor + 1); }  ///< members
    /// Of the far end's motion into a sample, from 0.
    std::span<const double> first(int sample) const { return row(far_end_, 2 * sample); }       ///< members
    std::span<const double> second(int sample) const { return row(far_end_, 2 * sample + 1); }  ///< members
    /// Of a correlation, where sensors tell of every tension, or only of the difference of a pair's.
    const ExpectedFraction& expected(bool tells_sum) const {
        return tells_sum ? expected_ : expected_without_sum_;
    }

  private:
    std::span<const double> row(const std::vector<double>& rows, int index) const {
        return std::span(rows).subspan(static_cast<std::size_t>(index) * members_, members_);
    }

    int members_;
    int samples_;
    ExpectedFraction expected_;
    ExpectedFraction expected_without_sum_;
    std::vector<double> parameters_;  // parameters x members
    std::vector<double> sensors_;     // 2 sensors x members
    std::vector<double> far_end_;     // 2 samples x members
};

/// centre + deviation * normals
std::vector<double> spread(double centre, double deviation, std::span<const double> normals);

}  // namespace capstan
