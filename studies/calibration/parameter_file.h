#pragma once

#include <filesystem>
#include <vector>

#include "capstan/calibration/twin.h"

namespace capstan::gap {

/// Reads a twin's parameters from what a calibration saved (JSON: `parameters`, a list of `name` and
/// `value`); a parameter that is not in the file stays nominal. Throws InvalidInput with everything wrong in
/// it.
std::vector<double> read_parameter_values(const std::filesystem::path& path,
                                          const std::vector<TwinParameter>& parameters);

}  // namespace capstan::gap
