#include "capstan/cli/watched_run.h"

#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/stop_request.h"
#include "capstan/paper/placement_comparison.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/progress.h"
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
    return {database_option, jobs_option,  output_option, json_option,
            progress_option, stats_option, help_option};
}

ExitCode watch(const Invocation& invocation, const std::string& name, const WatchedWork& work) {
    ProgressDisplay display(progress_mode(invocation.text("progress")));
    RunOptions options;
    options.jobs = static_cast<int>(invocation.integer("jobs"));
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

ExitCode run_watched_worlds(const Invocation& invocation, storage::Database* database, std::int64_t study_id,
                            const StudyPlan& plan) {
    ProgressDisplay display(progress_mode(invocation.text("progress")));
    WorldRunOptions options;
    options.jobs = static_cast<int>(invocation.integer("jobs"));
    options.on_progress = [&](const TableProgress& progress) {
        display.show(counted_progress(fmt::format("{}, {}", plan.name, progress.activity),
                                      static_cast<int>(progress.done), static_cast<int>(progress.total),
                                      "trials"));
    };
    const double start_s = wall_time_s();
    std::optional<WorldAnswer> found;
    {
        const StopRequest stoppable;
        options.stop = StopRequest::flag();
        try {
            found = database == nullptr ? run_worlds(plan, options)
                                        : run_worlds(*database, study_id, plan, options);
        } catch (const TableStopped&) {
        }
    }
    display.end_line();
    if (!found) {
        const std::string words =
            database == nullptr
                ? std::string("Stopped.")
                : fmt::format(
                      "Stopped; every finished block of worlds is kept. Go on with: capstan study resume {} --db {}",
                      study_id, database->path().string());
        say_end(display.mode() == ProgressMode::none ? ProgressMode::automatic : display.mode(), "stopped",
                words, study_id);
        return ExitCode::stopped;
    }
    if (database != nullptr)
        say_end(display.mode(), "complete",
                fmt::format("Study {} ({}) is complete in {}, after {:.2f} s.", study_id, plan.name,
                            database->path().string(), wall_time_s() - start_s),
                study_id);
    if (invocation.has("stats")) say(fmt::format("wall time: {:.2f} s", wall_time_s() - start_s));
    deliver_answer(invocation, answers::world_answer(plan, *found, study_id));
    return ExitCode::success;
}

void deliver_conclusions(const Invocation& invocation, storage::Database& database, std::int64_t study_id) {
    deliver_answer(invocation, answers::conclusions_answer(database, study_id));
}

}  // namespace capstan::cli
