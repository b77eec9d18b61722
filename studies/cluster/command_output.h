#pragma once

#include <string>
#include <vector>

namespace capstan::cluster {

struct CommandOutput {
    int exit_code = 0;
    std::string output;    ///< what it wrote to standard output
    std::string messages;  ///< and to standard error
};

/// Runs a program found on PATH, without a shell, and waits for it. Throws std::runtime_error if it cannot be
/// started.
CommandOutput run_command(const std::vector<std::string>& words);

bool is_on_path(const std::string& program);

}  // namespace capstan::cluster
