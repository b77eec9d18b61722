#pragma once

#include <functional>
#include <optional>
#include <string>

#include "capstan/cli/command.h"
#include "capstan/placement/study_run.h"
#include "capstan/placement/study_shard.h"
#include "capstan/platform/ended_by_signal.h"
#include "capstan/platform/progress.h"
#include "capstan/storage/database.h"
#include "capstan/worlds/world_study.h"

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

/// How work on a table of errors under watch ended.
struct WatchedTable {
    bool is_complete = false;  ///< false: stopped
    double wall_s = 0.0;
    ProgressMode mode = ProgressMode::none;
};
/// Runs `work` with progress shown and Ctrl-C caught.
WatchedTable watch_table(const Invocation& invocation, const std::string& name,
                         const std::function<void(const TableOptions&)>& work);

/// Runs a study over worlds with progress shown and Ctrl-C caught; nothing if it was stopped. Without a
/// database nothing is stored.
std::optional<WorldAnswer> watch_worlds(const Invocation& invocation, storage::Database* database,
                                        std::int64_t study_id, const StudyPlan& plan);

/// Throws UsageError where the plan is one with [uncertainty], which has no instants. `what`
/// is a command or an option.
void refuse_worlds(const StudyPlan& plan, const std::string& what);

/// Throws UsageError where a configuration with [uncertainty] has a [sweep]: shards are of one study.
void require_one_of_worlds(const std::vector<StudyPlan>& plans);

extern const Option from_diagnosis_option;
/// The truth of the plan's worlds is what the diagnosis of --from-diagnosis found, in the database of --db or
/// in a model's file.
void take_diagnosis(const Invocation& invocation, StudyPlan& plan);

/// The same, and gives the answer; `study_id` is 0 without a database.
ExitCode run_watched_worlds(const Invocation& invocation, storage::Database* database, std::int64_t study_id,
                            const StudyPlan& plan);

/// The answer of a study that is complete.
void deliver_conclusions(const Invocation& invocation, storage::Database& database, std::int64_t study_id);

extern const Option shard_option;

/// "2/8". Throws UsageError for anything else.
Shard parse_shard(const std::string& text);

/// Complete studies do not go into a shard's file, nor are they resumed in it. Throws UsageError that says
/// what to do instead.
void refuse_shard_file(storage::Database& database);

}  // namespace capstan::cli
