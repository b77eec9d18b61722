#include "capstan/cli/watched_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/cli/command.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/paper/placement_comparison.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/parsed_number.h"
#include "capstan/platform/progress.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/study_store.h"
#include "capstan/worlds/diagnosed_world.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan::cli {

namespace {

void say_times(const StudyTimes& times) {
    const std::pair<const char*, double> rows[] = {
        {"true motion, estimators' tables", times.prepare_s},
        {"readings, single sensors, paper's methods", times.paper_methods_s},
        {"feasible-curve methods", times.feasible_curve_s},
        {"statistics", times.statistics_s},
        {"recommendations, comparison", times.conclusions_s},
        {"database (wall time)", times.storage_s},
        {"from plan to database (wall time)", times.wall_s},
    };
    say("Processor time over all threads:");
    for (const auto& [what, seconds] : rows) say(fmt::format("  {:<42} {:>9.1f} ms", what, 1e3 * seconds));
}

void say_end(ProgressMode mode, const std::string& event, const std::string& words, std::int64_t study_id) {
    if (mode == ProgressMode::none) return;
    if (mode == ProgressMode::automatic) {
        say(words);
        return;
    }
    say(reports::json_line({{"event", event}, {"study_id", study_id}, {"message", words}}));
}

}  // namespace

std::vector<Option> watched_run_options() {
    return {database_option, jobs_option,     simd_option,  answer_output_option,
            json_option,     progress_option, stats_option, help_option};
}

ExitCode watch(const Invocation& invocation, const std::string& name, const WatchedWork& work) {
    ProgressDisplay display(progress_mode(invocation.text("progress")));
    RunOptions options;
    invocation.take("jobs", options.jobs);
    options.on_progress = [&](const StudyProgress& progress) {
        display.show(counted_progress(name, progress.units_done, progress.units, "units"));
    };
    options.compare_with_paper = paper::compare_placement;
    WatchedEnd ended;
    {
        const StopRequest stoppable;
        options.stop = StopRequest::flag();
        ended = work(options);
    }
    display.end_line();
    if (invocation.has("stats")) say_times(ended.times);
    switch (ended.end) {
        case RunEnd::stopped:
            // Printed even with --progress none: it is an answer, not progress.
            say_end(display.mode() == ProgressMode::none ? ProgressMode::automatic : display.mode(),
                    "stopped", ended.words, ended.study_id);
            return ExitCode::stopped;
        case RunEnd::complete:
            say_end(display.mode(), "complete", ended.words, ended.study_id);
            return ExitCode::success;
    }
    return ExitCode::failure;
}

ExitCode run_watched(const Invocation& invocation, storage::Database& database, const std::string& study_name,
                     const std::function<RunOutcome(const RunOptions&)>& work) {
    const std::string& file = invocation.text("db");
    std::int64_t study_id = 0;
    const ExitCode code = watch(invocation, study_name, [&](const RunOptions& options) -> WatchedEnd {
        const RunOutcome outcome = work(options);
        study_id = outcome.study_id;
        const std::string words =
            outcome.end == RunEnd::stopped
                ? fmt::format(
                      "Stopped; every finished unit is kept. Go on with: capstan study resume {} --db {}",
                      study_id, file)
                : fmt::format("Study {} ({}) is complete in {}, after {:.2f} s.", study_id, study_name, file,
                              outcome.times.wall_s);
        return {outcome.end, outcome.times, words, study_id};
    });
    if (code == ExitCode::success) deliver_conclusions(invocation, database, study_id);
    return code;
}

WatchedTable watch_table(const Invocation& invocation, const std::string& name,
                         const std::function<void(const TableOptions&)>& work) {
    ProgressDisplay display(progress_mode(invocation.text("progress")));
    TableOptions options;
    options.jobs = invocation.count("jobs");
    options.on_progress = [&](const TableProgress& progress) {
        display.show(counted_progress(fmt::format("{}, {}", name, progress.activity),
                                      static_cast<int>(progress.done), static_cast<int>(progress.total),
                                      "trials"));
    };
    const double start_s = wall_time_s();
    bool is_complete = false;
    {
        const StopRequest stoppable;
        options.stop = StopRequest::flag();
        try {
            work(options);
            is_complete = true;
        } catch (const TableStopped&) {
        }
    }
    display.end_line();
    return {is_complete, wall_time_s() - start_s, display.mode()};
}

std::optional<WorldAnswer> watch_worlds(const Invocation& invocation, storage::Database* database,
                                        std::int64_t study_id, const StudyPlan& plan) {
    std::optional<WorldAnswer> found;
    const WatchedTable watched = watch_table(invocation, plan.name, [&](const TableOptions& options) {
        found =
            database == nullptr ? run_worlds(plan, options) : run_worlds(*database, study_id, plan, options);
    });
    const double wall_s = watched.wall_s;
    const ProgressMode mode = watched.mode;
    if (!found) {
        const std::string words =
            database == nullptr
                ? std::string("Stopped; nothing is stored.")
                : fmt::format(
                      "Stopped; every finished block of worlds is kept. Go on with: capstan study resume {} --db {}",
                      study_id, database->path().string());
        say_end(mode == ProgressMode::none ? ProgressMode::automatic : mode, "stopped", words, study_id);
        return found;
    }
    if (database != nullptr)
        say_end(mode, "complete",
                fmt::format("Study {} ({}) is complete in {}, after {:.2f} s.", study_id, plan.name,
                            database->path().string(), wall_s),
                study_id);
    if (invocation.has("stats")) say(fmt::format("wall time: {:.2f} s", wall_s));
    return found;
}

ExitCode run_watched_worlds(const Invocation& invocation, storage::Database* database, std::int64_t study_id,
                            const StudyPlan& plan) {
    const std::optional<WorldAnswer> found = watch_worlds(invocation, database, study_id, plan);
    if (!found) return ExitCode::stopped;
    deliver_answer(invocation, answers::world_answer(plan, *found, study_id));
    return ExitCode::success;
}

void refuse_worlds(const StudyPlan& plan, const std::string& what) {
    if (!plan.uncertainty.is_stated) return;
    throw UsageError("capstan: " + what +
                     " is for studies at instants; a study with [uncertainty] compares sets of sensors over "
                     "complete motions");
}

void require_one_of_worlds(const std::vector<StudyPlan>& plans) {
    if (plans.size() == 1) return;
    throw UsageError(
        "capstan: shards are of one study over worlds, and this configuration has a [sweep]; run each of its "
        "studies from a configuration of its own");
}

const Option from_diagnosis_option{
    .name = "from-diagnosis",
    .value = "ID|FILE",
    .meaning =
        "The worlds of a CONFIG with [uncertainty] lie about what this diagnosis found, in the results database or in a "
        "model.toml of `capstan diagnose --save`: its friction, stiffness and pretension, and its causes with their "
        "probability, drawn from the intervals of the fit."};

namespace {

storage::DiagnosisRecord named_diagnosis(const Invocation& invocation) {
    const std::string& text = invocation.text("from-diagnosis");
    if (bench_model::names_a_model(text)) return answers::diagnosis_record(bench_model::read_model(text));
    const auto id = parsed_number<std::int64_t>(text);
    if (!id)
        throw UsageError(fmt::format(
            "capstan: --from-diagnosis is '{}', but must be the number of a diagnosis, which `capstan query "
            "\"SELECT * FROM v_diagnosis\"` lists, or a model.toml of `capstan diagnose --save`",
            text));
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    return storage::load_diagnosis(database, *id);
}

}  // namespace

void take_diagnosis(const Invocation& invocation, StudyPlan& plan) {
    if (!plan.uncertainty.is_stated)
        throw UsageError(
            "capstan: --from-diagnosis needs a CONFIG with [uncertainty], whose worlds it changes");
    const DiagnosedWorld found = world_of(named_diagnosis(invocation), plan.transmission.arrangement);
    for (const std::string& cause : found.left_out)
        say(fmt::format("Note: {} is not of the cable and is left out.", cause));
    if (found.truth.has_effects() && plan.motion.distal.kind == EndKind::spring)
        throw UsageError(fmt::format(
            "capstan: the diagnosis found {}, and effects are simulated between ends whose positions are given, but "
            "[motion.distal] is a spring. Make it kind = \"position\" and state how far the far end itself moves as "
            "uncertainty.far_end_range_m, or give a diagnosis without effects",
            fmt::join(effects_there(found.truth.effects), ", ")));
    plan.truth = found.truth;
    plan.uncertainty.truth_probability = found.probability;
}

void deliver_conclusions(const Invocation& invocation, storage::Database& database, std::int64_t study_id) {
    deliver_answer(invocation, answers::conclusions_answer(database, study_id));
}

const Option shard_option{
    .name = "shard",
    .value = "I/N",
    .meaning =
        "Run only part I of N (I from 1) into a file of its own. `capstan study merge` joins all N, "
        "with the same bits as one run. Running the command again continues the part."};

Shard parse_shard(const std::string& text) {
    const std::size_t slash = std::min(text.find('/'), text.size() - 1);
    const auto number = parsed_number<int>(text.substr(0, slash));
    const auto count = parsed_number<int>(text.substr(slash + 1));
    if (number && count && *number >= 1 && *number <= *count) return {*number, *count};
    throw UsageError(fmt::format(
        "--shard is '{}', but must be I/N with I from 1 to N, for example --shard 2/8 for the second "
        "of eight",
        text));
}

void refuse_shard_file(storage::Database& database) {
    const auto mark = storage::read_shard(database);
    if (!mark) return;
    const std::string file = database.path().string();
    throw UsageError(
        fmt::format("{0} is the file of {1}. To continue it: capstan study run CONFIG --shard "
                    "{2}/{3} --db {0}\nFor a complete study, name another file with --db.",
                    file, words_of(*mark), mark->shard, mark->shards));
}

}  // namespace capstan::cli
