#pragma once

#include <cmath>

namespace capstan {

/// How far the bristles between cable and conduit are bent, in parts of full friction: -1 to 1.
struct Bristle {
    double bend = 0.0;
    double bend_per_m = 0.0;  ///< slope with further sliding
};

/// Friction that builds up over a small displacement before the cable slides (E22, Dahl):
/// dz / du = (1 - z sign(du))^exponent / length, friction = z times full friction.
struct Presliding {
    double length_m = 0.0;  ///< 0: as stiff as numerics need
    double exponent = 1.0;  ///< 0: straight to full friction, 1: ever more slowly

    Bristle after(double bend, double slid_m) const {
        // Not moved yet: on, the way the bristles are bent.
        const double way = (slid_m == 0.0 ? bend : slid_m) < 0.0 ? -1.0 : 1.0;
        const double gap = 1.0 - way * bend;  // to full friction this way
        const double path = std::abs(slid_m) / length_m;
        if (exponent == 0.0) {
            return gap > path ? Bristle{bend + slid_m / length_m, 1.0 / length_m} : Bristle{way, 0.0};
        }
        if (exponent == 1.0) {
            const double left = gap * std::exp(-path);
            return {way * (1.0 - left), left / length_m};
        }
        // gap^(1 - n) falls linearly along the path.
        const double power = 1.0 - exponent;
        const double left_power = std::pow(gap, power) - power * path;
        if (left_power <= 0.0) return {way, 0.0};
        const double left = std::pow(left_power, 1.0 / power);
        return {way * (1.0 - left), std::pow(left, exponent) / length_m};
    }
};

}  // namespace capstan
