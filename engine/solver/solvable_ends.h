#pragma once

#include <cmath>

#include "capstan/solver/end_condition.h"

namespace capstan {

/// Products of two such numbers are still finite, and no cable, in any unit, comes near.
inline constexpr double largest_number = 1e150;

/// Drawn outward a spring must pull more, else it is none, and there may be any number of answers or none.
/// `outward` is the sign of a displacement that leaves the cable.
inline bool springs_back(const EndCondition& end, double outward) {
    return outward * end.displacement_factor * end.tension_factor >= 0.0;
}

/// A step has an answer: two lines of numbers, no spring that pushes back the wrong way, and not a tension at
/// both ends.
inline bool solvable(const EndConditions& ends) {
    const auto& [p, d] = ends;
    const double proximal_size = std::abs(p.displacement_factor) + std::abs(p.tension_factor);
    const double distal_size = std::abs(d.displacement_factor) + std::abs(d.tension_factor);
    const double size = proximal_size + distal_size + std::abs(p.value) + std::abs(d.value);
    const double position = std::abs(p.displacement_factor) + std::abs(d.displacement_factor);
    // The first is false for NaN too.
    return size <= largest_number && proximal_size > 0.0 && distal_size > 0.0 && position > 0.0 &&
           springs_back(p, -1.0) && springs_back(d, 1.0);
}

/// Throws InvalidInput with what is wrong with end conditions that are not solvable.
[[noreturn]] void refuse(const EndConditions& ends);

}  // namespace capstan
