#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/cli/watched_run.h"
#include "capstan/cluster/worker.h"
#include "capstan/platform/standard_streams.h"

namespace capstan::cli {

namespace {

using cluster::StudyDirectory;

ExitCode run_study_status(const Invocation& invocation) {
    const cluster::StudyStatus status = cluster::status_of(invocation.argument("DIR"));
    if (!status.queue_problem.empty())
        say("The queue cannot be asked, so only the files are known: " + status.queue_problem);
    deliver_answer(invocation, answers::submitted_study_answer(status));
    return ExitCode::success;
}

}  // namespace

Command study_status_command() {
    return {
        .name = "study status",
        .summary = "Show the progress of a submitted study.",
        .description =
            "Shows for every shard in a folder made by `capstan study submit` or `capstan batch` whether it is done, "
            "running, late, waiting, failed (started, but neither in the queue nor at work; with the last line of its "
            "log) or not started, how many of its units are stored, who works on it, and its state in the queue; then "
            "what is left in time and core-hours, and what to do next. It reads the shards' files and leases, and also "
            "works without the scheduler.",
        .arguments = {{"DIR", "The study's folder.", ArgumentNeed::optional, "capstan-study"}},
        .options = {output_option, json_option, help_option},
        .examples = {"capstan study status atlas", "capstan study status atlas --json | jq -r .merge.state"},
        .run = run_study_status,
        .time = "Less than 2 s for some hundred shards, in proportion to their number."};
}

namespace {

ExitCode run_study_work(const Invocation& invocation) {
    const StudyDirectory directory = cluster::read_directory(invocation.argument("DIR"));
    if (!directory.simd.empty())
        limit_simd(directory.simd, "the folder states --simd ");
    else
        use_stated_simd(invocation);
    std::optional<int> own;
    invocation.take("shard", own);
    if (own && *own > directory.shards)
        throw UsageError(fmt::format("--shard is {}, but the study has {} shards", *own, directory.shards));
    cluster::WorkOptions work_options;
    work_options.program_version = program_version();
    work_options.say = [](const std::string& text) { say(text); };
    work_options.late_after_s = invocation.number("late");
    return watch(invocation, directory.name, [&](const RunOptions& options) -> WatchedEnd {
        work_options.run = options;
        if (!invocation.has("jobs")) work_options.run.jobs = directory.processors_per_shard;
        const units::WorkEnd worked = invocation.has("merge") ? cluster::merge(directory, work_options)
                                                              : cluster::work(directory, own, work_options);
        if (worked == units::WorkEnd::failed)
            throw std::runtime_error(
                "a command of the batch failed; the lines above say which, and the same "
                "command tries again");
        const RunEnd end = worked == units::WorkEnd::stopped ? RunEnd::stopped : RunEnd::complete;
        const std::string words =
            end == RunEnd::stopped ? "Stopped; every finished unit is kept. The same command goes on."
            : std::filesystem::exists(directory.merged_file())
                ? fmt::format("{} is complete: {}", directory.batch ? "The batch" : "The study",
                              directory.merged_file().string())
                : "Nothing is left to do here; other workers have the other shards.";
        return {end, {}, words, 0};
    });
}

}  // namespace

Command study_work_command() {
    return {
        .name = "study work",
        .summary = "Work on the shards of a submitted study.",
        .description =
            "Runs shards in a folder made by `capstan study submit` or `capstan batch`, one after the other, until none is left; any "
            "number of such workers on any machines share the folder, each shard under a lease. Where all shards "
            "have been begun, a worker waits beside one that runs and computes it once more if it is late (longer "
            "than --late and than three times the median shard) or its worker has died; both give the same bits. "
            "The last worker joins the shards into study.db, or the answers of a batch into results.json. The jobs of schedulers call it; by hand it serves "
            "where there is none.",
        .arguments = {{"DIR", "The study's folder.", ArgumentNeed::optional, "capstan-study"}},
        .options = {{.name = "shard",
                     .kind = OptionKind::integer,
                     .value = "I",
                     .meaning = "Run this shard, whoever has it, and no other that is free.",
                     .limits = {1, 1e6}},
                    {.name = "merge", .meaning = "Only join the shards, if that is not done."},
                    {.name = "late",
                     .kind = OptionKind::number,
                     .value = "SECONDS",
                     .meaning = "A shard is never late before that.",
                     .default_value = "30",
                     .limits = {0, 1e9}},
                    {.name = "jobs",
                     .letter = 'j',
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Number of threads, instead of the processors per task of the submission.",
                     .limits = {0, 1024}},
                    simd_option,
                    progress_option,
                    help_option},
        .examples = {"capstan study work atlas", "capstan study work atlas --shard 7"},
        .run = run_study_work,
        .time = "Until no shard is left, so as long as the study or batch. Shows progress.",
        .when_stopped = "stopped by Ctrl-C or a request to terminate; the same command continues"};
}

}  // namespace capstan::cli
