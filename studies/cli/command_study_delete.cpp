#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode run_study_delete(const Invocation& invocation) {
    storage::Database database = storage::Database::open_existing(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const std::string name = storage::load_study(database, id).study.name;
    storage::delete_study(database, id);
    say(fmt::format("Deleted study {} ({}).", id, name));
    return ExitCode::success;
}

}  // namespace

Command study_delete_command() {
    return {.name = "study delete",
            .summary = "Delete a study and everything that belongs to it.",
            .description =
                "Deletes a study and everything that belongs to it. This cannot be undone. The study must be "
                "named.",
            .arguments = {{"STUDY", "Its number, its name (the newest study of that name), or latest."}},
            .options = {database_option, help_option},
            .examples = {"capstan study delete 3"},
            .run = run_study_delete};
}

}  // namespace capstan::cli
