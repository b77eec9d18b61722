#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/program.h"
#include "capstan/cli/shard_option.h"
#include "capstan/cli/watched_run.h"
#include "capstan/placement/stored_study.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode resume_one(const Invocation& invocation, storage::Database& database, std::int64_t id) {
    const StoredStudy stored = load_stored_study(database, id);
    const storage::StudyRecord& study = stored.description.study;
    if (study.status == "complete") {
        say(fmt::format("Study {} ({}) is complete already; nothing to do.", id, study.name));
        deliver_conclusions(invocation, database, id);
        return ExitCode::success;
    }
    if (study.program_version != program_version()) {
        say(fmt::format(
            "Note: study {} was started by capstan {}, and this is {}; the remaining units may differ in "
            "the last bits.",
            id, study.program_version, program_version()));
    }
    return run_watched(invocation, database, study.name, [&](const RunOptions& options) {
        return resume_study(database, id, stored.plan, options);
    });
}

// A study named "all" must be given by its number.
ExitCode resume_all(const Invocation& invocation, storage::Database& database) {
    int running = 0;
    for (const storage::StudySummary& study : storage::list_studies(database)) {
        if (study.status == "complete") continue;
        ++running;
        const ExitCode code = resume_one(invocation, database, study.study_id);
        if (code != ExitCode::success) return code;
    }
    if (running == 0) say("All studies are complete already; nothing to do.");
    return ExitCode::success;
}

ExitCode run_study_resume(const Invocation& invocation) {
    storage::Database database = storage::Database::open_existing(invocation.text("db"));
    refuse_shard_file(database);
    const std::string& named = invocation.argument("STUDY");
    if (named == "all") return resume_all(invocation, database);
    return resume_one(invocation, database, storage::find_study(database, named));
}

}  // namespace

Command study_resume_command() {
    return {.name = "study resume",
            .summary = "Continue a study that was stopped or killed.",
            .description =
                "Continues a study that was stopped or killed, from the configuration stored with it. Stored "
                "units are kept; the tables end with the same bits as without the interruption.",
            .arguments = {{"STUDY", "Its number, its name (the newest study of that name), latest, or all.",
                           ArgumentNeed::optional, "latest"}},
            .options = watched_run_options(),
            .examples = {"capstan study resume", "capstan study resume paper --db paper.db"},
            .run = run_study_resume,
            .can_be_stopped = true};
}

}  // namespace capstan::cli
