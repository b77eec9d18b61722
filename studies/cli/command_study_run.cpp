#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/cli/watched_run.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "capstan/placement/stored_study.h"
#include "capstan/placement/study_merge.h"
#include "capstan/platform/simd_width.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/storage/study_store.h"
#include "capstan/worlds/world_shard.h"

namespace capstan::cli {

namespace {

std::string seconds(const StudyTimes& times) {
    return fmt::format("{:.2f} s", times.wall_s);
}

ExitCode run_one(const Invocation& invocation, const StudyPlan& plan) {
    storage::Database database = storage::Database::open_or_create(invocation.text("db"));
    refuse_shard_file(database);
    return run_watched(invocation, database, plan.name, [&](const RunOptions& options) {
        return run_study(database, plan, program_version(), options);
    });
}

ExitCode run_sweep(const Invocation& invocation, const std::string& name,
                   const std::vector<StudyPlan>& plans) {
    const std::string& file = invocation.text("db");
    storage::Database database = storage::Database::open_or_create(file);
    refuse_shard_file(database);
    return watch(invocation, name, [&](const RunOptions& options) -> WatchedEnd {
        const RunOutcome outcome = run_studies(database, plans, program_version(), options);
        const std::string words =
            outcome.end == RunEnd::complete
                ? fmt::format(
                      "All {} studies of {} are complete in {}, after {}; `capstan study list --db {}` lists them, "
                      "`capstan recommend STUDY` shows the recommendation of each.",
                      plans.size(), name, file, seconds(outcome.times), file)
                : fmt::format(
                      "Stopped; every finished unit is kept. Go on with: capstan study resume all --db {}",
                      file);
        return {outcome.end, outcome.times, words, 0};
    });
}

ExitCode run_part(const Invocation& invocation, const std::string& name,
                  const std::vector<StudyPlan>& plans) {
    const Shard shard = parse_shard(invocation.text("shard"));
    const std::string& file = invocation.text("db");
    require_useful(plans, shard);
    storage::Database database = storage::Database::open_or_create(file, storage::Journal::rollback);
    return watch(
        invocation, fmt::format("{}, {}", name, words_of(shard)),
        [&](const RunOptions& options) -> WatchedEnd {
            const ShardOutcome outcome = run_shard(database, plans, shard, program_version(), options);
            const std::string words =
                outcome.end == RunEnd::complete
                    ? fmt::format("{} of {} is done in {}, after {}; `capstan study merge` joins all {}.",
                                  words_of(shard), name, file, seconds(outcome.times), shard.count)
                    : "Stopped; every finished unit is kept. The same command goes on.";
            return {outcome.end, outcome.times, words, 0};
        });
}

// The same study twice: once with the estimators' model as the truth, once with what --truth says.
ExitCode run_both_truths(const Invocation& invocation, const StudyPlan& with_truth) {
    StudyPlan model = with_truth;
    model.truth = {};
    StudyPlan truth = with_truth;
    truth.name += ", truth " + std::filesystem::path(invocation.text("truth")).stem().string();
    const std::string& file = invocation.text("db");
    storage::Database database = storage::Database::open_or_create(file);
    refuse_shard_file(database);
    std::int64_t ids[2] = {0, 0};
    const ExitCode code = watch(invocation, truth.name, [&](const RunOptions& options) -> WatchedEnd {
        RunOutcome outcome;
        StudyTimes times;
        for (const StudyPlan* plan : {&model, &truth}) {
            outcome = run_study(database, *plan, program_version(), options);
            ids[plan == &truth ? 1 : 0] = outcome.study_id;
            times = outcome.times;
            if (outcome.end == RunEnd::stopped) break;
        }
        const std::string words =
            outcome.end == RunEnd::complete
                ? fmt::format("Studies {} (the model is the truth) and {} ({}) are complete in {}.", ids[0],
                              ids[1], truth.name, file)
                : fmt::format(
                      "Stopped; every finished unit is kept. Go on with: capstan study resume {} --db {}",
                      outcome.study_id, file);
        return {outcome.end, times, words, outcome.study_id};
    });
    if (code != ExitCode::success) return code;
    deliver_answer(invocation, answers::truth_answer(database, ids[0], ids[1]));
    return code;
}

ExitCode run_world_part(const Invocation& invocation, const std::vector<StudyPlan>& plans) {
    const Shard shard = parse_shard(invocation.text("shard"));
    require_one_of_worlds(plans);
    require_worlds_for(plans.front(), shard.count);  // before there is a file
    const std::string& file = invocation.text("db");
    storage::Database database = storage::Database::open_or_create(file, storage::Journal::rollback);
    const std::string name = fmt::format("{}, {}", plans.front().name, words_of(shard));
    const WatchedTable watched = watch_table(invocation, name, [&](const TableOptions& options) {
        run_world_shard(database, plans.front(), {shard.number, shard.count}, program_version(), options);
    });
    if (!watched.is_complete) {
        say("Stopped; every finished block of worlds is kept. The same command goes on.");
        return ExitCode::stopped;
    }
    say(fmt::format("{} of {} is done in {}, after {:.2f} s; `capstan study merge` joins all {}.",
                    words_of(shard), plans.front().name, file, watched.wall_s, shard.count));
    return ExitCode::success;
}

ExitCode run_all_worlds(const Invocation& invocation, const std::vector<StudyPlan>& plans) {
    if (invocation.has("shard")) return run_world_part(invocation, plans);
    storage::Database database = storage::Database::open_or_create(invocation.text("db"));
    refuse_shard_file(database);
    std::vector<std::int64_t> ids;
    for (const StudyPlan& plan : plans) ids.push_back(begin_worlds(database, plan, program_version()));
    ExitCode code = ExitCode::success;
    for (std::size_t k = 0; k < plans.size() && code == ExitCode::success; ++k)
        code = run_watched_worlds(invocation, &database, ids[k], plans[k]);
    return code;
}

ExitCode run_study_run(const Invocation& invocation) {
    use_stated_simd(invocation);
    config::ReadConfig config = read_config_of(invocation);
    if (invocation.has("from-diagnosis")) take_diagnosis(invocation, config.plan);
    const std::vector<StudyPlan> plans = config::runnable_studies(config);
    if (config.plan.uncertainty.is_stated) return run_all_worlds(invocation, plans);
    if (invocation.has("truth") && !invocation.has("shard") && plans.size() == 1)
        return run_both_truths(invocation, plans.front());
    if (invocation.has("shard")) return run_part(invocation, config.plan.name, plans);
    if (plans.size() > 1) return run_sweep(invocation, config.plan.name, plans);
    return run_one(invocation, plans.front());
}

const Option truth_option{
    .name = "truth",
    .value = "FILE",
    .meaning =
        "The true cable differs from the model as the [truth] in FILE says; `capstan diagnose "
        "--corrected` writes such a file. Runs the study with either truth and reports whether the "
        "advice changes."};

}  // namespace

Command study_run_command() {
    std::vector<Option> options = watched_run_options();
    options.insert(options.begin() + 2, {seed_option, repetitions_option, truth_option, from_diagnosis_option,
                                         far_end_option, shard_option});
    return {
        .name = "study run",
        .summary = "Run a study and recommend sensors.",
        .description =
            "Runs the study that CONFIG describes, stores it in the results database, and recommends "
            "which sensors to use, where, and how to fuse them. A database holds any number of studies; "
            "a CONFIG with a [sweep] gives one study for each combination. Ctrl-C stops after the "
            "current unit, and a killed run loses no more than that unit: `capstan study resume` "
            "continues with the same bits. With --shard only one part is run, so that a cluster can run "
            "all parts at once; `capstan study submit` does that.",
        .arguments = {config_argument},
        .options = std::move(options),
        .examples = {"capstan study run configs/quick.toml",
                     "capstan study run configs/paper.toml --db paper.db --stats",
                     "capstan study run my.toml --repetitions 50 --json | jq .recommendations",
                     "capstan study run my.toml --truth corrected.toml",
                     "capstan study run my.toml --shard 2/8 --db part-2.db"},
        .run = run_study_run,
        .time =
            "quick.toml takes a second, paper.toml some seconds, a sweep minutes to hours: `capstan study plan` estimates it. "
            "Shows progress and the time left.",
        .when_stopped = can_be_resumed};
}

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
    use_simd_of(invocation, storage::read_computations(database, id));
    for (const storage::Computation& before : storage::read_computations(database, id))
        if (before.simd != simd_width())
            say(fmt::format(
                "Note: study {} was begun with SIMD {}, and this is {}; the remaining units may differ in "
                "the last bits.",
                id, before.simd, simd_width()));
    if (stored.plan.uncertainty.is_stated) return run_watched_worlds(invocation, &database, id, stored.plan);
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
            .time = "As long as `study run` for the units that are left. Shows progress and the time left.",
            .when_stopped = can_be_resumed};
}

namespace {

// Whether it holds worlds. From now on the program uses the vector instructions that it was computed with.
bool look_at_first(const Invocation& invocation, const std::vector<std::filesystem::path>& shards) {
    use_stated_simd(invocation);
    if (!std::filesystem::exists(shards.front())) return false;  // reported with the others
    storage::Database database = storage::Database::open_read_only(shards.front());
    for (const storage::StudySummary& study : storage::list_studies(database))
        use_simd_of(invocation, storage::read_computations(database, study.study_id));
    return holds_worlds(database);
}

ExitCode run_study_merge(const Invocation& invocation) {
    const std::string& file = invocation.text("db");
    const auto& names = invocation.repeated_argument();
    const std::vector<std::filesystem::path> shards(names.begin(), names.end());
    if (look_at_first(invocation, shards)) {
        const WatchedTable watched = watch_table(invocation, "merge", [&](const TableOptions& options) {
            merge_world_shards(file, shards, options);
        });
        say(watched.is_complete
                ? fmt::format(
                      "Merged {} shards into {}; `capstan recommend --db {}` shows the recommendation.",
                      shards.size(), file, file)
                : std::string("Stopped; nothing was written, and the shards are as they were."));
        return watched.is_complete ? ExitCode::success : ExitCode::stopped;
    }
    return watch(invocation, "merge", [&](const RunOptions& options) -> WatchedEnd {
        const RunEnd end = merge_shards(file, shards, options);
        const std::string words =
            end == RunEnd::complete
                ? fmt::format("Merged {} into {}; `capstan recommend --db {}` shows the recommendation.",
                              counted(shards.size(), "shard"), file, file)
                : "Stopped; nothing was written, and the shards are as they were.";
        return {end, {}, words, 0};
    });
}

}  // namespace

Command study_merge_command() {
    return {
        .name = "study merge",
        .summary = "Join the shards of a study.",
        .description =
            "Joins the files written by `capstan study run --shard` into a new database and computes the "
            "recommendations. Every table has the same bits as after one run. Every shard must be given "
            "once, be finished, belong to the same study, hold what was written (by its content hashes), and "
            "be computed with the same program and vector instructions. Otherwise nothing is written, and "
            "every missing, repeated, foreign, unfinished, damaged or different shard is named.",
        .arguments = {{"SHARD", "The files of all shards, in any order.", ArgumentNeed::one_or_more}},
        .options = {{.name = "db",
                     .value = "FILE",
                     .meaning = "The new database; it is written completely or not at all.",
                     .default_value = "capstan.db"},
                    jobs_option,
                    simd_option,
                    progress_option,
                    help_option},
        .examples = {"capstan study merge --db atlas.db shard-*.db"},
        .run = run_study_merge,
        .time = "Some seconds per gigabyte of shards. Shows progress.",
        .when_stopped = can_be_resumed};
}

}  // namespace capstan::cli
