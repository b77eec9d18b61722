#pragma once

#include <algorithm>
#include <vector>

namespace capstan::gap_trial {

/// A motion between its fine samples: cubic, with the slopes of central differences.
class MotionBetweenSamples {
  public:
    MotionBetweenSamples(const std::vector<double>& samples, double rate_Hz)
        : samples_(samples), rate_Hz_(rate_Hz) {}

    struct Point {
        double value = 0.0;
        double speed = 0.0;
        double acceleration = 0.0;
    };

    /// `share` (0 to 1) of the way from `sample` to the next.
    Point at(std::size_t sample, double fraction) const {
        const double here = value(sample);
        const double next = value(sample + 1);
        const double slope = half_difference(sample);
        const double next_slope = half_difference(sample + 1);
        const double rise = next - here;
        const double c = 3.0 * rise - 2.0 * slope - next_slope;
        const double d = slope + next_slope - 2.0 * rise;
        const double s = fraction;
        return {here + s * (slope + s * (c + s * d)), rate_Hz_ * (slope + s * (2.0 * c + 3.0 * s * d)),
                rate_Hz_ * rate_Hz_ *
                    ((1.0 - s) * second_difference(sample) + s * second_difference(sample + 1))};
    }

  private:
    double value(std::size_t sample) const { return samples_[std::min(sample, samples_.size() - 1)]; }
    double half_difference(std::size_t sample) const {
        return sample == 0 ? 0.0 : 0.5 * (value(sample + 1) - value(sample - 1));
    }
    double second_difference(std::size_t sample) const {
        return sample == 0 ? 0.0 : value(sample + 1) - 2.0 * value(sample) + value(sample - 1);
    }

    const std::vector<double>& samples_;
    double rate_Hz_;
};

}  // namespace capstan::gap_trial
