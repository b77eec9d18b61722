#pragma once

#include <filesystem>

#include "capstan/config/config_reader.h"

namespace capstan::config {

/// Makes the far end of the plan's worlds move as a log recorded it: a CSV file with the columns time_s and
/// displacement_m, read at the rate of [motion] and rounded to nanometres. far_end_range_m and
/// far_end_bandwidth_Hz become those of the log unless the configuration states them. Throws InvalidInput
/// with every problem of the log, by line.
void take_far_end_log(ReadConfig& config, const std::filesystem::path& log);

/// The same for a configuration that names a log, relative to its own folder, and does not hold the log's
/// samples. Others stay as they are.
void take_named_far_end_log(ReadConfig& config);

}  // namespace capstan::config
