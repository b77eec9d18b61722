#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace capstan {

/// Where the sensors sit: nodes in rising order, counted from 0 at the proximal end.
struct Layout {
    std::string family;      ///< "even", "distal", "both" or "explicit"
    std::string start;       ///< "proximal" or "distal" where a family has two variants, else empty
    std::string label;       ///< for people
    std::vector<int> nodes;  // sensors
};

/// A rule that places any number of sensors; the paper's three are Sec. III.C.
struct LayoutFamily {
    std::string_view name;
    std::string_view title;
    std::string_view meaning;
    /// All variants with `count` sensors on a cable of `nodes` nodes, 1 <= count <= nodes.
    std::vector<Layout> (*layouts)(int count, int nodes);
};

/// Every family, in the paper's order.
const std::vector<LayoutFamily>& layout_families();
const LayoutFamily* find_layout_family(std::string_view name);

/// Any set of nodes, in any order, given from 0; the layout lists them in rising order.
Layout explicit_layout(std::vector<int> nodes);

/// "1, 6, 11" for nodes 0, 5, 10: as people count.
std::string nodes_as_people_count(const std::vector<int>& nodes);

}  // namespace capstan
