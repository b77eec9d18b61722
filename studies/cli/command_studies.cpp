#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/placement/replay.h"
#include "capstan/placement/stored_study.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/reports/query_rows.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

bool has_word(const std::string& words, const std::string& wanted) {
    return (" " + words + " ").find(" " + wanted + " ") != std::string::npos;
}

ExitCode run_study_list(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const bool json = invocation.has("json");
    const bool deleted = invocation.has("deleted");
    storage::QueryResult table =
        answers::studies_table(database, deleted ? storage::Shelf::trash : storage::Shelf::studies);
    if (invocation.has("tag")) {
        std::erase_if(table.rows, [&](const std::vector<storage::QueryValue>& row) {
            return !has_word(std::get<std::string>(row.back()), invocation.text("tag"));
        });
    }
    if (!json) {
        table.columns.front() = "study";
        table.columns[5] = "begun (UTC)";
    }
    if (table.rows.empty() && !json) {
        say(deleted ? "The trash is empty."
                    : fmt::format("{} has no such study yet; `capstan study run CONFIG` creates one.",
                                  invocation.text("db")));
    }
    deliver(invocation, json ? reports::rows_json(table) : reports::rows_text(table));
    return ExitCode::success;
}

}  // namespace

Command study_list_command() {
    return {
        .name = "study list",
        .summary = "List the studies of a database.",
        .description =
            "Lists the studies of a database, oldest first: the progress of each, when it was begun, "
            "its note and its tags. `capstan query \"SELECT * FROM history\"` has every command.",
        .options = {{.name = "deleted",
                     .meaning = "List the trash instead: `capstan study restore` takes a study out of it."},
                    {.name = "tag", .value = "WORD", .meaning = "List only studies with this tag."},
                    database_option,
                    output_option,
                    json_option,
                    help_option},
        .examples = {"capstan study list", "capstan study list --tag thesis"},
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
    return {
        .name = "study show",
        .summary = "Show a study and its progress.",
        .description =
            "Shows a study's cable, instants, noise levels, layouts, methods and progress; --config "
            "prints the complete configuration, from which the study can be run again.",
        .arguments = {study_argument},
        .options = {database_option,
                    {.name = "config", .meaning = "Print the stored configuration (TOML) with every key."},
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
    const Replay replayed = replay(stored.plan, address, invocation.count("jobs"));
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
                         .limits = {1, max_number}},
                        {.name = "noise",
                         .kind = OptionKind::integer,
                         .value = "N",
                         .meaning = "Number of the noise level.",
                         .default_value = "1",
                         .limits = {1, max_number}},
                        {.name = "repetition",
                         .kind = OptionKind::integer,
                         .value = "N",
                         .meaning = "Number of the repetition.",
                         .default_value = "1",
                         .limits = {1, max_number}},
                        database_option,
                        jobs_option,
                        output_option,
                        json_option,
                        help_option},
            .examples = {"capstan study replay --scenario 2 --repetition 17"},
            .run = run_study_replay,
            .time = "As long as one repetition of the study, mostly less than 2 s."};
}

namespace {

ExitCode run_study_delete(const Invocation& invocation) {
    storage::Database database = storage::Database::open_existing(invocation.text("db"));
    const bool for_good = invocation.has("forever");
    const std::string& named = invocation.argument("STUDY");
    // What is in the trash already can be removed by its number.
    const auto deleted = storage::list_studies(database, storage::Shelf::trash);
    const bool is_there = std::ranges::any_of(
        deleted, [&](const storage::StudySummary& study) { return std::to_string(study.study_id) == named; });
    const std::int64_t id = storage::find_study(
        database, named, for_good && is_there ? storage::Shelf::trash : storage::Shelf::studies);
    const std::string name = storage::load_study(database, id).study.name;
    if (for_good) {
        storage::delete_study(database, id);
        say(fmt::format("Removed study {} ({}) for good.", id, name));
    } else {
        storage::trash_study(database, id);
        say(fmt::format("Deleted study {} ({}). `capstan study restore {}` brings it back.", id, name, id));
    }
    return ExitCode::success;
}

ExitCode run_study_restore(const Invocation& invocation) {
    storage::Database database = storage::Database::open_existing(invocation.text("db"));
    const std::int64_t id =
        storage::find_study(database, invocation.argument("STUDY"), storage::Shelf::trash);
    storage::restore_study(database, id);
    say(fmt::format("Restored study {} ({}).", id, storage::load_study(database, id).study.name));
    return ExitCode::success;
}

// Single blanks, each word once, in the order given.
std::string tidy_tags(const std::string& text) {
    std::istringstream words(text);
    std::string tags;
    for (std::string word; words >> word;)
        if (!has_word(tags, word)) tags += (tags.empty() ? "" : " ") + word;
    return tags;
}

ExitCode run_study_note(const Invocation& invocation) {
    std::optional<std::string> note, tags;
    if (invocation.has_argument("TEXT")) note = invocation.argument("TEXT");
    if (invocation.has("tags")) tags = tidy_tags(invocation.text("tags"));
    if (!note && !tags)
        throw UsageError(
            "capstan study note: give a TEXT, --tags, or both; an empty text removes what there was");
    storage::Database database = storage::Database::open_existing(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    storage::annotate_study(database, id, note, tags);
    return ExitCode::success;
}

}  // namespace

Command study_delete_command() {
    return {
        .name = "study delete",
        .summary = "Delete a study; `study restore` brings it back.",
        .description =
            "Puts a study into the trash of its database, where no command finds it and from where `capstan "
            "study restore` brings it back. Its rows stay in the tables and views of SQL. With --forever it "
            "is removed with everything that belongs to it, which cannot be undone. No number is given to "
            "two studies. The study must be named.",
        .arguments = {{"STUDY", "Its number, its name (the newest study of that name), or latest."}},
        .options = {{.name = "forever",
                     .meaning = "Remove the study, or one that is in the trash, for good."},
                    database_option,
                    help_option},
        .examples = {"capstan study delete 3", "capstan study delete 3 --forever"},
        .run = run_study_delete};
}

Command study_restore_command() {
    return {.name = "study restore",
            .summary = "Bring a deleted study back.",
            .description =
                "Takes a study out of the trash of its database; `capstan study list --deleted` lists it.",
            .arguments = {{"STUDY", "Its number, its name (the newest study of that name), or latest."}},
            .options = {database_option, help_option},
            .examples = {"capstan study restore 3"},
            .run = run_study_restore};
}

Command study_note_command() {
    return {
        .name = "study note",
        .summary = "Give a study a note and tags.",
        .description = "Writes a note on a study, and tags to find it by; `capstan study list` shows both.",
        .arguments = {{"STUDY", "Its number, its name (the newest study of that name), or latest."},
                      {"TEXT", "The note, in quotes. An empty text removes it.", ArgumentNeed::optional}},
        .options = {{.name = "tags",
                     .value = "WORDS",
                     .meaning = "Its tags, in quotes, separated by blanks."},
                    database_option,
                    help_option},
        .examples = {"capstan study note 3 \"with the new conduit\" --tags \"thesis chapter-4\""},
        .run = run_study_note};
}

}  // namespace capstan::cli
