#pragma once

#include <string>

#include "capstan/cli/command.h"

namespace capstan::cli {

/// "md", "csv", "json" or what else --format may name: as asked for, else as the output file's name ends, else
/// `otherwise`.
std::string answer_format(const Invocation& invocation, const std::string& otherwise);

}  // namespace capstan::cli
