#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace capstan {

/// The points of a centre line [m]: a CSV file with the columns x_m, y_m and z_m, in any order and beside
/// others. Throws InvalidInput with every problem by file and line: a column that is missing, what is not a
/// finite number, a point that repeats the one before it.
std::vector<std::array<double, 3>> read_points(const std::filesystem::path& path);

}  // namespace capstan
