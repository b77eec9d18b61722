#pragma once

#include <functional>

#include "capstan/logs/log.h"

namespace capstan::logs {

/// Reads `log` in a process of its own, for libraries that trust the file: where they crash, take too long or
/// too much memory, the file is refused, and this program goes on. `read` fills a log in that process; all of
/// it is handed over. Throws InvalidInput: what `read` threw, or that the process ended.
void read_isolated(Log& log, const ReadOptions& options,
                   const std::function<void(const ReadOptions& options, Log& log)>& read);

}  // namespace capstan::logs
