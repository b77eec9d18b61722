#pragma once

#include <string>
#include <vector>

#include "capstan/cli/exit_code.h"

namespace capstan::cli {

/// The program: finds the command, runs it, and says on standard error what went wrong. `words` are the
/// command line without the program's name.
ExitCode run_program(const std::vector<std::string>& words);

/// As stored with each study.
std::string program_version();

}  // namespace capstan::cli
