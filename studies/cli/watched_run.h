#pragma once

#include <functional>
#include <string>

#include "capstan/cli/command.h"
#include "capstan/placement/study_run.h"
#include "capstan/storage/database.h"

namespace capstan::cli {

/// Options of every command that computes a study.
std::vector<Option> watched_run_options();

/// How work under watch ended, and the sentence that says so.
struct WatchedEnd {
    RunEnd end = RunEnd::complete;
    StudyTimes times;
    std::string words;
    std::int64_t study_id = 0;  ///< in the JSON event; 0: several studies
};
using WatchedWork = std::function<WatchedEnd(const RunOptions&)>;

/// Runs `work` with progress shown and Ctrl-C caught, and says how it ended.
ExitCode watch(const Invocation& invocation, const std::string& name, const WatchedWork& work);

/// Runs `work` with progress shown and Ctrl-C caught, then gives the study's conclusions, or says how to go
/// on.
ExitCode run_watched(const Invocation& invocation, storage::Database& database, const std::string& study_name,
                     const std::function<RunOutcome(const RunOptions&)>& work);

/// The same for a study over worlds; without a database nothing is stored and `study_id` is 0.
ExitCode run_watched_worlds(const Invocation& invocation, storage::Database* database, std::int64_t study_id,
                            const StudyPlan& plan);

/// The answer of a study that is complete.
void deliver_conclusions(const Invocation& invocation, storage::Database& database, std::int64_t study_id);

}  // namespace capstan::cli
