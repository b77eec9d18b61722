#pragma once

#include <cmath>

#include "capstan/solver/end_condition.h"

namespace capstan {

/// A step has an answer: two lines of finite numbers, and not a tension at both ends.
inline bool solvable(const EndConditions& ends) {
    const auto& [p, d] = ends;
    // Nothing times a number is nothing, unless the number is not finite.
    const double nothing = (0.0 * p.displacement_factor + 0.0 * p.tension_factor + 0.0 * p.value) +
                           (0.0 * d.displacement_factor + 0.0 * d.tension_factor + 0.0 * d.value);
    const double proximal_size = std::abs(p.displacement_factor) + std::abs(p.tension_factor);
    const double distal_size = std::abs(d.displacement_factor) + std::abs(d.tension_factor);
    const double position = std::abs(p.displacement_factor) + std::abs(d.displacement_factor);
    return nothing == 0.0 && proximal_size > 0.0 && distal_size > 0.0 && position > 0.0;
}

/// Throws InvalidInput with what is wrong with end conditions that are not solvable.
[[noreturn]] void refuse(const EndConditions& ends);

}  // namespace capstan
