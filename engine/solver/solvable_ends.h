#pragma once

#include <cmath>

#include "capstan/solver/end_condition.h"

namespace capstan {

/// Finite, and not without meaning.
inline bool is_line(const EndCondition& end) {
    // Nothing times a number is nothing, unless the number is not finite.
    const bool finite = 0.0 * end.displacement_factor + 0.0 * end.tension_factor + 0.0 * end.value == 0.0;
    return finite && std::abs(end.displacement_factor) + std::abs(end.tension_factor) > 0.0;
}

/// A step has an answer: two lines, and not a tension at both ends.
inline bool solvable(const EndConditions& ends) {
    return is_line(ends.proximal) && is_line(ends.distal) &&
           (ends.proximal.displacement_factor != 0.0 || ends.distal.displacement_factor != 0.0);
}

/// Throws InvalidInput with what is wrong with end conditions that are not solvable.
[[noreturn]] void refuse(const EndConditions& ends);

}  // namespace capstan
