#include "capstan/estimation/tension_reading.h"

#include <algorithm>

namespace capstan {

SensorSpot spot_at(const Cable& cable, double position_m) {
    const double place = std::clamp(position_m / cable.segment_length_m(), 0.0, 1.0 * cable.segments());
    const int node = std::min(static_cast<int>(place), cable.segments() - 1);
    return {node, place - node};
}

SensorSpot spot_of_node(const Cable& cable, int node) {
    return node == cable.segments() ? SensorSpot{node - 1, 1.0} : SensorSpot{node, 0.0};
}

}  // namespace capstan
