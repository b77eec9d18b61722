#pragma once

#include <vector>

#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"

namespace capstan::config {

/// What is wrong with the values of a plan, at the lines of the keys that they belong to. `known`: problems
/// of reading the same file; what follows from one of them is left out.
std::vector<ConfigProblem> value_problems(const ReadConfig& config, const std::vector<ConfigProblem>& known);
std::vector<ConfigProblem> value_problems(const ReadBench& bench, const std::vector<ConfigProblem>& known);

/// Throws ConfigError with everything that keeps the study from running, at the lines of the keys.
void require_runnable(const ReadConfig& config);

/// The studies that a configuration describes, one without a sweep; each checked. Throws ConfigError or
/// InvalidInput with what is wrong with any of them.
std::vector<StudyPlan> runnable_studies(const ReadConfig& config);

}  // namespace capstan::config
