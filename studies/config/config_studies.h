#pragma once

#include <vector>

#include "capstan/config/config_reader.h"

namespace capstan::config {

/// The studies that a configuration describes, one without a sweep; each checked. Throws ConfigError or
/// InvalidInput with what is wrong with any of them.
std::vector<StudyPlan> runnable_studies(const ReadConfig& config);

}  // namespace capstan::config
