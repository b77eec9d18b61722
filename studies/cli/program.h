#pragma once

#include <string>
#include <vector>

#include "capstan/cli/command.h"

namespace capstan::cli {

/// The program: finds the command, runs it, and says on standard error what went wrong. `words` are the
/// command line without the program's name.
ExitCode run_program(const std::vector<std::string>& words);

/// As stored with each study.
std::string program_version();

/// The widest vector instructions in use, by Highway's name: "SCALAR", "SSSE3", "SSE4", "AVX2", "AVX3".
std::string simd_in_use();

/// Takes no wider instructions than the environment variable CAPSTAN_SIMD names, for a proof that results do
/// not hang on the processor; without it all that the processor has. To be called before the first step.
/// Throws UsageError for a name that this processor or this program does not have.
void limit_simd_from_environment();

}  // namespace capstan::cli
