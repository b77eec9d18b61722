#pragma once

#include <string>
#include <vector>

#include "capstan/cli/config_problem.h"
#include "capstan/cli/config_reader.h"

namespace capstan::cli {

/// Keys that are right by themselves but do not fit each other, as a sensor beyond the last node. Keys among
/// the `known` problems are left alone.
std::vector<ConfigProblem> inconsistencies_of(const ReadConfig& config,
                                              const std::vector<ConfigProblem>& known);
std::vector<ConfigProblem> inconsistencies_of(const ReadBench& bench,
                                              const std::vector<ConfigProblem>& known);

/// What is wrong with a cable's two friction coefficients beside each other; empty if nothing.
std::string friction_problem(const CableSpecification& cable);

}  // namespace capstan::cli
