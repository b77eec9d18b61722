#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace capstan::logs {

/// "torque (an object of the class timeseries)" for each variable of a MATLAB file of versions 5 to 7 that is
/// an object. libmatio passes over them without a word. Nothing of a file that is damaged.
std::vector<std::string> matlab_objects(const std::filesystem::path& path);

}  // namespace capstan::logs
