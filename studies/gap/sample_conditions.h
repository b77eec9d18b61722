#pragma once

#include <array>
#include <string>
#include <vector>

#include "capstan/gap/gap_map.h"

namespace capstan::gap {

/// Ways to sort a recording's samples, and what each way calls its parts. A sample that has no place in one
/// of them is in part -1.
struct SampleSorting {
    std::string by;
    std::vector<std::string> parts;
    std::vector<std::vector<int>> part_of;  // runs x samples
};

/// By regime, direction, speed, tension, time since reversal, and time in the session.
std::vector<SampleSorting> sample_sortings(const Recording& recording, const std::vector<RunResiduals>& runs);

}  // namespace capstan::gap
