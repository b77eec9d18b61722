#pragma once

#include <vector>

#include "capstan/cli/config_reader.h"

namespace capstan::cli {

/// The studies that a configuration describes, one without a sweep; each with its own full configuration, and
/// checked. Throws ConfigError or InvalidInput with what is wrong with any of them.
std::vector<StudyPlan> runnable_studies(const ReadConfig& config);

/// A configuration of the command line, with --seed, --repetitions and --truth in place of its own.
ReadConfig read_config_of(const class Invocation& invocation);

}  // namespace capstan::cli
