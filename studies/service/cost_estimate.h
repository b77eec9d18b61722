#pragma once

#include <string>
#include <vector>

#include "capstan/service/exchange.h"
#include "capstan/service/job_queue.h"
#include "capstan/service/routes.h"

namespace capstan::service {

/// {"known": true, "seconds": S, "studies": N}: what the studies of a configuration take on this machine, by
/// `capstan study plan` in a process of its own, or by the beginning of the study where that has no instants.
/// {"known": false} where that refuses the configuration; with "may_be_long": true where it was killed or
/// took more than a minute, as on a busy machine.
ordered_json cost_of_studies(const JobCommands& commands, const std::string& toml, bool is_over_worlds);

/// The same of one command, such as {"place", "study.toml"}: it is begun, and its own progress tells after a
/// few seconds how much is left. Nothing that it writes is kept. "is_at_least": true where its progress is
/// that of one part of the work, or says nothing.
ordered_json cost_of_command(const JobCommands& commands, const std::vector<std::string>& words);

/// The same of the diagnosis of a recording, by `capstan diagnose --cost`. What it finds decides how long it
/// takes: "seconds" is the longest, "min_seconds" the shortest. A recording that cannot be diagnosed has
/// "problems", the command's messages, one a line.
ordered_json cost_of_diagnosis(const JobCommands& commands, const std::string& log);

/// The same of an uploaded recording.
ordered_json cost_of_diagnosis(const JobCommands& commands, const UploadedRecording& recording);

}  // namespace capstan::service
