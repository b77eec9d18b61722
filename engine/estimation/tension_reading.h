#pragma once

#include "capstan/cable/cable_state.h"
#include "capstan/sensing/noise.h"

namespace capstan {

/// A place on the cable: `fraction` of the way from `node` to the next, 0 to 1. The tension there is
/// interpolated between the two.
struct SensorSpot {
    int node = 0;  ///< from 0, at most nodes - 2
    double fraction = 0.0;
};

/// The spot `position_m` from the proximal end; one beyond the cable's ends is taken to be at the end.
inline SensorSpot spot_at(const Cable& cable, double position_m) {
    const Cable::Spot spot = cable.spot_at(position_m);
    return {spot.segment, spot.fraction};
}

/// The spot of a node.
inline SensorSpot spot_of_node(const Cable& cable, int node) {
    return node == cable.segments() ? SensorSpot{node - 1, 1.0} : SensorSpot{node, 0.0};
}

inline double tension_at_N(const CableState& state, const SensorSpot& spot) {
    const auto node = static_cast<std::size_t>(spot.node);
    return (1.0 - spot.fraction) * state.tension_N[node] + spot.fraction * state.tension_N[node + 1];
}

/// What a sensor says at one sample.
struct TensionReading {
    SensorSpot spot;
    double value_N = 0.0;
    NoiseLevel noise;
};

/// A correlation between few members counts by how far it is beyond this many variances of chance: 4 is two
/// standard deviations. Without, chance correlations shrink the spread of what rests a little in every step,
/// until the band there is far too narrow.
inline constexpr double chance_variances = 4.0;

/// A slack node's multiplicative noise has no width; a tenth of a millinewton keeps its likelihood finite.
inline constexpr double smallest_deviation_N = 1e-4;

}  // namespace capstan
