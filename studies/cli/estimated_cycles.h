#pragma once

#include "capstan/cli/command.h"

namespace capstan::cli {

/// `capstan estimate CONFIG`: a study's layouts scored over its whole motion, as a table or JSON.
ExitCode estimate_cycles(const Invocation& invocation);

}  // namespace capstan::cli
