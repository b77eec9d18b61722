#include <fmt/format.h>

#include <cstdio>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/program.h"
#include "capstan/cli/watched_run.h"
#include "capstan/config/config_writer.h"
#include "capstan/placement/stored_study.h"
#include "capstan/placement/study_extension.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/storage/study_store.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan::cli {

namespace {

// A name or `latest` may find an extension that was killed; the study to extend is the complete one before
// it.
StudyToExtend study_to_extend(const Invocation& invocation, storage::Database& database) {
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const StoredStudy stored = load_stored_study(database, id);
    const storage::StudyRecord& study = stored.description.study;
    if (study.status == "complete") return {id, stored.plan};
    const auto studies = storage::list_studies(database);
    for (auto before = studies.rbegin(); before != studies.rend(); ++before) {
        if (before->study_id >= id || before->name != study.name || before->status != "complete") continue;
        const StudyToExtend smaller{before->study_id, load_stored_study(database, before->study_id).plan};
        if (config::config_text(smaller.with_repetitions(study.repetitions), config::Comments::none) ==
            study.config_toml)
            return smaller;
    }
    throw UsageError(fmt::format(
        "study {} ({}) is not complete, so there is nothing to extend yet. `capstan study resume {} --db {}` "
        "completes it.",
        id, study.name, id, invocation.text("db")));
}

std::string extension_message(const Invocation& invocation, const StudyToExtend& study,
                              const ExtensionOutcome& outcome) {
    const std::string& file = invocation.text("db");
    if (outcome.run.end == RunEnd::stopped)
        return "Stopped; every finished unit is kept. The same command goes on.";
    std::string words;
    if (outcome.run.study_id == study.study_id) {
        words = fmt::format("Study {} needs no more than its {} repetitions.", study.study_id,
                            outcome.repetitions);
    } else {
        words =
            fmt::format("Study {} ({}) has {} repetitions and is complete in {}; study {} is still there.",
                        outcome.run.study_id, study.plan.name, outcome.repetitions, file, study.study_id);
    }
    if (outcome.unresolved_N) {
        const bool resolved = *outcome.unresolved_N <= invocation.number("until-resolved");
        words += fmt::format(
            " With 95 % certainty no layout is better than the best of its count by more than "
            "{:.4f} N{}.",
            *outcome.unresolved_N,
            resolved ? "" : ", which is not within the tolerance; --max-repetitions stopped it");
    }
    return words;
}

// A new study beside the one that is there: which sets were left out, and when, depends on the number of
// worlds.
ExitCode extend_worlds(const Invocation& invocation, storage::Database& database,
                       const StudyToExtend& study) {
    if (invocation.has("until-resolved")) refuse_worlds(study.plan, "--until-resolved");
    const StudyPlan larger = study.with_repetitions(invocation.count("repetitions"));
    if (larger.repetitions <= study.plan.repetitions)
        throw UsageError(fmt::format("--repetitions is {}, but study {} has {} worlds already; ask for more",
                                     larger.repetitions, study.study_id, study.plan.repetitions));
    const std::int64_t id = begin_worlds(database, larger, program_version());
    return run_watched_worlds(invocation, &database, id, larger);
}

ExitCode run_study_extend(const Invocation& invocation) {
    if (invocation.has("repetitions") == invocation.has("until-resolved")) {
        throw UsageError(
            "capstan study extend: give either --repetitions (the total number of repetitions) or "
            "--until-resolved (the tolerance in newtons)");
    }
    storage::Database database = storage::Database::open_existing(invocation.text("db"));
    refuse_shard_file(database);
    const StudyToExtend study = study_to_extend(invocation, database);
    if (study.plan.uncertainty.is_stated) return extend_worlds(invocation, database, study);
    ExtensionOutcome outcome;
    const ExitCode code = watch(invocation, study.plan.name, [&](const RunOptions& options) -> WatchedEnd {
        if (invocation.has("repetitions")) {
            outcome =
                extend_study(database, study, invocation.count("repetitions"), program_version(), options);
        } else {
            Resolution resolution;
            resolution.tolerance_N = invocation.number("until-resolved");
            resolution.max_repetitions = invocation.count("max-repetitions");
            if (invocation.text("progress") == "auto") {
                resolution.on_look = [](int repetitions, double unresolved_N) {
                    say(fmt::format("{} repetitions: another layout may still be better by up to {:.4f} N",
                                    repetitions, unresolved_N));
                };
            }
            outcome = extend_until_resolved(database, study, resolution, program_version(), options);
        }
        return {outcome.run.end, outcome.run.times, extension_message(invocation, study, outcome),
                outcome.run.study_id};
    });
    if (code == ExitCode::success) deliver_conclusions(invocation, database, outcome.run.study_id);
    return code;
}

}  // namespace

Command study_extend_command() {
    std::vector<Option> options = watched_run_options();
    const std::vector<Option> own = {
        {.name = "repetitions",
         .kind = OptionKind::integer,
         .value = "N",
         .meaning = "Total number of repetitions of the extended study.",
         .limits = {2, 1e7}},
        {.name = "until-resolved",
         .kind = OptionKind::number,
         .value = "TOLERANCE",
         .meaning =
             "Double the repetitions until, with 95 % certainty, no layout is better than the best of its "
             "count by more than TOLERANCE newtons, at every noise level, objective and number of sensors.",
         .limits = {1e-6, 1e6}},
        {.name = "max-repetitions",
         .kind = OptionKind::integer,
         .value = "N",
         .meaning = "Largest number of repetitions with --until-resolved.",
         .default_value = "128000",
         .limits = {2, 1e7}}};
    options.insert(options.begin() + 1, own.begin(), own.end());
    return {
        .name = "study extend",
        .summary = "Give a stored study more repetitions.",
        .description =
            "Runs a stored study with more repetitions, from the configuration stored with it. The "
            "larger study contains the draws of the smaller one. It is stored beside it under the same "
            "name, with the same bits as a run with that number of repetitions from the start. Sums, "
            "quantiles and the weights of the W methods use all repetitions, so all results are computed "
            "again. If the command is killed or stopped, running it again continues the study.",
        .arguments = {study_argument},
        .options = std::move(options),
        .examples = {"capstan study extend --repetitions 8000",
                     "capstan study extend paper --until-resolved 0.002"},
        .run = run_study_extend,
        .time = "As long as a study with the new number of repetitions. Shows progress and the time left.",
        .when_stopped = can_be_resumed};
}

}  // namespace capstan::cli
