#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode run_study_show(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    if (invocation.has("config")) {
        deliver(invocation, storage::load_study(database, id).study.config_toml);
    } else {
        deliver_answer(invocation, answers::study_answer(database, id));
    }
    return ExitCode::success;
}

}  // namespace

Command study_show_command() {
    return {.name = "study show",
            .summary = "Show a study and its progress.",
            .description =
                "Shows a study's cable, instants, noise levels, layouts, methods and progress; --config "
                "prints the complete configuration, from which the study can be run again.",
            .arguments = {study_argument},
            .options = {database_option,
                        {.name = "config",
                         .kind = OptionKind::flag,
                         .meaning = "Print the stored configuration (TOML) with every key."},
                        output_option,
                        json_option,
                        help_option},
            .examples = {"capstan study show", "capstan study show 3 --config -o again.toml"},
            .run = run_study_show};
}

}  // namespace capstan::cli
