#pragma once

#include "capstan/effects/effect_row.h"

namespace capstan {

/// A stretch of the cable's path, in metres from the motor end.
struct Stretch {
    double from_m = 0.0;
    double to_m = 0.0;

    /// Fraction of the stretch that lies in [from, to].
    double fraction_within(double from, double to) const {
        const double low = from > from_m ? from : from_m;
        const double high = to < to_m ? to : to_m;
        return high > low && to_m > from_m ? (high - low) / (to_m - from_m) : 0.0;
    }
};

inline Stretch stretch_around(double middle_m, double length_m) {
    return {middle_m - 0.5 * length_m, middle_m + 0.5 * length_m};
}

/// The parameters of a stretch in a catalogue row.
inline EffectParameter middle_of_stretch() {
    return {.name = "middle", .unit = "m", .high = 100.0, .typical = 1.0, .role = ParameterRole::place};
}
inline EffectParameter length_of_stretch(double typical_m) {
    return {.name = "length",
            .unit = "m",
            .low = 1e-3,
            .high = 10.0,
            .typical = typical_m,
            .role = ParameterRole::shape};
}

}  // namespace capstan
