#pragma once

#include "capstan/cli/config_reader.h"

namespace capstan::cli {

/// Throws ConfigError with the problems that the study finds in the plan, at the lines of the keys that they
/// name.
void require_runnable(const ReadConfig& config);

}  // namespace capstan::cli
