#pragma once
// The cable as an inline SVG: straightened, its bends marked, the sensors pinned on it.

#include <string>
#include <vector>

#include "capstan/reports/table.h"

namespace capstan::reports {

// segments: the table cable_segment. Nodes are counted from 1 at the proximal (motor) end.
std::string cable_drawing(const Table& segments, const std::vector<int>& sensor_nodes);

// Arc length of every node from the proximal end; nodes = segments + 1.
std::vector<double> node_positions_m(const Table& segments);

}  // namespace capstan::reports
