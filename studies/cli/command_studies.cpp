#include <fmt/format.h>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/placement/replay.h"
#include "capstan/placement/stored_study.h"
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

namespace {

// The number given with an option, from 1, as an index; a UsageError states the valid range.
int position(const Invocation& invocation, std::string_view option, std::size_t count) {
    const std::int64_t given = invocation.integer(option);
    if (given > static_cast<std::int64_t>(count)) {
        throw UsageError(
            fmt::format("capstan study replay: --{} is {}, but the study has 1 to {}; `capstan study show` "
                        "lists them",
                        option, given, count));
    }
    return static_cast<int>(given - 1);
}

ExitCode run_study_replay(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const StoredStudy stored = load_stored_study(database, id);
    refuse_worlds(stored.plan, "study replay");
    const auto& study = stored.description;
    const ReplayAddress address{
        position(invocation, "scenario", study.scenarios.size()),
        position(invocation, "noise", study.noise_levels.size()),
        position(invocation, "repetition", static_cast<std::size_t>(study.study.repetitions))};
    const Replay replayed = replay(stored.plan, address, static_cast<int>(invocation.integer("jobs")));
    deliver_answer(invocation, answers::replay_answer(replayed, study.scenarios[address.scenario_index],
                                                      study.noise_levels[address.noise_index].label,
                                                      address.repetition + 1));
    return ExitCode::success;
}

}  // namespace

Command study_replay_command() {
    constexpr double max_number = 1e9;
    return {.name = "study replay",
            .summary = "Re-run one repetition of a study: readings, estimates, errors.",
            .description =
                "Re-runs a single repetition exactly as in the study: the same readings, the same estimates. "
                "Instants, noise levels and repetitions count from 1, in the order in which `capstan study "
                "show` lists them.",
            .arguments = {study_argument},
            .options = {{.name = "scenario",
                         .kind = OptionKind::integer,
                         .value = "N",
                         .meaning = "Number of the instant.",
                         .default_value = "1",
                         .low = 1,
                         .high = max_number},
                        {.name = "noise",
                         .kind = OptionKind::integer,
                         .value = "N",
                         .meaning = "Number of the noise level.",
                         .default_value = "1",
                         .low = 1,
                         .high = max_number},
                        {.name = "repetition",
                         .kind = OptionKind::integer,
                         .value = "N",
                         .meaning = "Number of the repetition.",
                         .default_value = "1",
                         .low = 1,
                         .high = max_number},
                        database_option,
                        jobs_option,
                        output_option,
                        json_option,
                        help_option},
            .examples = {"capstan study replay --scenario 2 --repetition 17"},
            .run = run_study_replay};
}

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
