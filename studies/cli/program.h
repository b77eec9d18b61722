#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "capstan/cli/command.h"

namespace capstan::cli {

/// The program: finds the command, runs it, and says on standard error what went wrong. `words` are the
/// command line without the program's name.
ExitCode run_program(const std::vector<std::string>& words);

/// As stored with each study.
std::string program_version();

/// Takes no wider instructions than the environment variable CAPSTAN_SIMD names, for a proof that results do
/// not hang on the processor; without it all that the processor has. To be called before the first step.
/// Throws UsageError for a name that this processor or this program does not have.
void limit_simd_from_environment();

/// Whether it does.
bool simd_is_limited();

/// The same for a width that was given in another way: "--simd ".
void limit_simd(std::string_view wanted, std::string_view origin);

}  // namespace capstan::cli
