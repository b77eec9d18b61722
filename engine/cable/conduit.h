#pragma once

#include <numbers>
#include <vector>

#include "capstan/cable/cable.h"

namespace capstan {

inline constexpr double rad_per_degree = std::numbers::pi / 180.0;

/// A bend as a drawing states it: by its angle and its radius; its length is their product.
struct Bend {
    double angle_rad = 0.0;
    double radius_m = 0.0;
    double at_m = 0.0;  ///< where it begins, along the conduit from the proximal end

    double end_m() const { return at_m + angle_rad * radius_m; }
};

/// Everything wrong with a conduit of these bends, in any order, by "bend[2].at_m" and "length_m".
std::vector<KeyProblem> problems_of(const std::vector<Bend>& bends, double length_m);

/// The pieces of a conduit that is straight between its bends. Throws InvalidInput with every problem.
std::vector<CurvaturePiece> pieces_of(std::vector<Bend> bends, double length_m);

}  // namespace capstan
