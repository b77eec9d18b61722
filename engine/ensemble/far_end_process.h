#pragma once

#include <cmath>

namespace capstan {

/// 95% of a normal distribution lie within this many standard deviations.
inline constexpr double deviations_of_95 = 1.959963984540054;

/// What a person does with the far end, as far as it is known: a stationary Gaussian process that begins at
/// rest. Its acceleration is a = -2 r v - r^2 y + white noise, the smoothest process with two states (Matern
/// 3/2).
struct FarEndMotion {
    double range_m = 0.0;       ///< 95% of the time within plus and minus this; 0: the end stays where it is
    double bandwidth_Hz = 2.0;  ///< 95% of its power lies below
};

/// y and v after one sample in exact form: (y, v) = A (y, v) + L (e1, e2), e standard normal (E40).
class FarEndProcess {
  public:
    FarEndProcess(const FarEndMotion& motion, double interval_s) {
        // The power below w is (2 / pi) (atan x + x / (1 + x^2)) of all, x = w / r: 0.95 at x = 1.8385.
        constexpr double power_95 = 1.8385;
        const double rate = 2.0 * 3.141592653589793 * motion.bandwidth_Hz / power_95;
        const double decay = std::exp(-rate * interval_s);
        const double variance = motion.range_m * motion.range_m / (deviations_of_95 * deviations_of_95);
        yy_ = decay * (1.0 + rate * interval_s);
        yv_ = decay * interval_s;
        vy_ = -decay * rate * rate * interval_s;
        vv_ = decay * (1.0 - rate * interval_s);
        // What keeps the process stationary: Q = P - A P A', P = variance * diag(1, r^2).
        const double p_v = variance * rate * rate;
        const double q_yy = variance - yy_ * yy_ * variance - yv_ * yv_ * p_v;
        const double q_yv = -yy_ * vy_ * variance - yv_ * vv_ * p_v;
        const double q_vv = p_v - vy_ * vy_ * variance - vv_ * vv_ * p_v;
        noise_yy_ = std::sqrt(std::fmax(q_yy, 0.0));
        noise_vy_ = noise_yy_ > 0.0 ? q_yv / noise_yy_ : 0.0;
        noise_vv_ = std::sqrt(std::fmax(q_vv - noise_vy_ * noise_vy_, 0.0));
    }

    bool moves() const { return noise_yy_ > 0.0; }

    void advance(double& displacement_m, double& speed_m_per_s, double first_normal,
                 double second_normal) const {
        const double y = displacement_m;
        const double v = speed_m_per_s;
        displacement_m = yy_ * y + yv_ * v + noise_yy_ * first_normal;
        speed_m_per_s = vy_ * y + vv_ * v + noise_vy_ * first_normal + noise_vv_ * second_normal;
    }

  private:
    double yy_, yv_, vy_, vv_;
    double noise_yy_, noise_vy_, noise_vv_;
};

}  // namespace capstan
