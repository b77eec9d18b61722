#pragma once

#include <vector>

#include "capstan/cable/cable.h"

namespace capstan {

/// Two places closer than this are one.
inline constexpr double same_place_m = 1e-6;
/// A segment with less is straight: it is rounding of where a bend ends.
inline constexpr double smallest_wrap_rad = 1e-9;

double length_m(const std::vector<CurvaturePiece>& pieces);
/// By how much all pieces bend together.
double wrap_rad(const std::vector<CurvaturePiece>& pieces);
/// The same between two places.
double wrap_between_rad(const std::vector<CurvaturePiece>& pieces, double from_m, double to_m);

/// Where bends begin and end, without the ends of the cable; rising. Between two straight pieces none does.
std::vector<double> bend_ends_m(const std::vector<CurvaturePiece>& pieces);

/// These places in order, those that are the same or an end of the cable left out.
std::vector<double> distinct_places_m(std::vector<double> places_m, double length_m);

/// Nodes at all of `fixed_m`, rising, and the others of `segments` one by one in the part between two of them
/// whose segments turn most, by `turn_rad_per_m` of each part; of those that turn alike, whose segments are
/// longest.
std::vector<double> nodes_between(const std::vector<double>& fixed_m,
                                  const std::vector<double>& turn_rad_per_m, int segments);

/// All nodes of a specification, from 0 to the length. Its numbers must be valid.
std::vector<double> node_positions_m(const CableSpecification& specification);

/// The specification with every segment cut into `pieces` equal ones.
CableSpecification refined(CableSpecification specification, int pieces);

/// The specification with neighbouring straight segments made one: without friction between its ends (E1)
/// nothing is different at the nodes that are left, but for rounding.
CableSpecification with_straight_joined(CableSpecification specification);

}  // namespace capstan
