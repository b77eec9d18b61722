#pragma once

#include <string>
#include <vector>

#include "capstan/cli/command.h"

namespace capstan::cli {

/// What follows a command's name, checked against the command. Throws UsageError.
Invocation parse_command_line(const Command& command, const std::vector<std::string>& arguments);

}  // namespace capstan::cli
