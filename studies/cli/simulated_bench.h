#pragma once

#include "capstan/cli/command.h"

namespace capstan::cli {

/// `capstan simulate BENCH`: a described bench over time, as CSV, and as a page where asked.
ExitCode simulate_bench_file(const Invocation& invocation);

}  // namespace capstan::cli
