#pragma once

#include <string>

namespace capstan::cli {

/// Completion scripts for shells, written from the table of commands.
std::string bash_completion();
std::string zsh_completion();

}  // namespace capstan::cli
