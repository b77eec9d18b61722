#pragma once

#include <array>
#include <vector>

#include "capstan/cable/cable.h"

namespace capstan {

/// Measured points along a conduit's centre line, in the order from the proximal end.
struct CentreLine {
    std::vector<std::array<double, 3>> points_m;
    double noise_m = 0.0;  ///< standard deviation of each coordinate of each point, independent
};

/// Fewer do not tell a bend from noise.
inline constexpr int min_centre_line_points = 8;

/// A conduit as its centre line shows it.
struct MeasuredConduit {
    std::vector<CurvaturePiece> pieces;
    std::vector<double>
        wrap_deviation_rad;            ///< pieces: standard deviation of the wrap angle; 0 where straight
    double wrap_rad = 0.0;             ///< of all pieces
    double total_deviation_rad = 0.0;  ///< of all pieces together
    double residual_m = 0.0;           ///< rms distance of the points' coordinates from the smooth line
};

/// Everything wrong with a centre line, by "points" and "noise_m".
std::vector<KeyProblem> problems_of(const CentreLine& line);

/// Smooths the points and cuts the smooth line into pieces of constant radius (E46 to E48). The smoothest
/// line is taken that the noise allows, so that a straight line of noisy points has no bend. A bend is split
/// where its radius changes. Deviations come from smoothing points with fresh noise about the smooth line,
/// and hold the bias of smoothing as well. Same points, same result. Throws InvalidInput with
/// problems_of(line).
MeasuredConduit measured_conduit(const CentreLine& line);

}  // namespace capstan
