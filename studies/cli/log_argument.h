#pragma once

#include <filesystem>

#include "capstan/cli/command.h"

namespace capstan::cli {

extern const Argument log_argument;

/// True if a file's name is that of a recording (CSV or its JSON sidecar) rather than of a configuration.
bool names_a_recording(const std::filesystem::path& path);

}  // namespace capstan::cli
