#pragma once

#include "capstan/cli/command.h"

namespace capstan::cli {

/// `capstan simulate LOG`: the twin of a recording, moved by its driven channels, as CSV in the recording's
/// form.
ExitCode simulate_recording(const Invocation& invocation);

}  // namespace capstan::cli
