#include <fmt/format.h>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode run_study_list(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const bool json = invocation.has("json");
    storage::QueryResult table{{json ? "study_id" : "study", "name", "status", "units_done", "units"}, {}};
    for (const storage::StudySummary& study : storage::list_studies(database)) {
        table.rows.push_back({study.study_id, study.name, study.status, std::int64_t{study.units_done},
                              std::int64_t{study.units}});
    }
    if (table.rows.empty() && !json) {
        say(fmt::format("{} has no study yet; `capstan study run CONFIG` creates one.",
                        invocation.text("db")));
    }
    deliver(invocation, json ? answers::rows_json(table) : answers::rows_text(table));
    return ExitCode::success;
}

}  // namespace

Command study_list_command() {
    return {.name = "study list",
            .summary = "List the studies of a database.",
            .description = "Lists the studies of a database, oldest first, with the progress of each.",
            .options = {database_option, output_option, json_option, help_option},
            .examples = {"capstan study list"},
            .run = run_study_list};
}

}  // namespace capstan::cli
