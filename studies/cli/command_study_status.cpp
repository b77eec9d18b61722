#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/cli/watched_run.h"
#include "capstan/cluster/shard_record.h"
#include "capstan/cluster/study_queue.h"
#include "capstan/cluster/worker.h"
#include "capstan/platform/files.h"
#include "capstan/platform/simd_width.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/units/lease.h"
#include "capstan/units/result_units.h"
#include "capstan/units/unit_record.h"

namespace capstan::cli {

namespace {

using cluster::QueuedTask;
using cluster::StudyDirectory;
using reports::Data;

// State of a shard or of the merge.
struct TaskStatus {
    std::string
        state;  // done, running, late, waiting, failed, not_started; without its scheduler also unfinished
    cluster::ShardProgress progress;
    std::optional<QueuedTask> task;
    std::string worker;   // that holds its lease
    std::string message;  // the last line of the log of one that failed
};

struct StudyStatus {
    StudyDirectory directory;
    const cluster::Scheduler* scheduler = nullptr;  // null: it is not on this machine, or there is none
    std::vector<TaskStatus> shards;
    TaskStatus merge;
    cluster::Outlook outlook;
};

std::string state_of(bool is_done, bool was_begun, const std::optional<QueuedTask>& task, bool knows_queue) {
    if (is_done) return "done";
    if (task) return task->is_running() ? "running" : "waiting";
    if (!was_begun) return "not_started";
    return knows_queue ? "failed" : "unfinished";
}

TaskStatus shard_status(const StudyStatus& status, const cluster::StudyQueue& queue, double now_s,
                        int number) {
    const StudyDirectory& directory = status.directory;
    const cluster::WorkOptions usual;
    TaskStatus shard;
    shard.progress = cluster::progress_of(directory, number);
    if (const auto task = queue.shards.find(number); task != queue.shards.end()) shard.task = task->second;
    shard.state =
        state_of(shard.progress.is_done(), shard.progress.was_begun, shard.task, status.scheduler != nullptr);
    units::DiskFolder leases = directory.leases();
    if (shard.state != "done" && units::is_held(leases, units::lease_of(number), now_s)) {
        shard.state =
            units::is_late(leases, number, usual.late_after_s, usual.late_factor) ? "late" : "running";
        if (const auto lease = units::read_lease(leases, units::lease_of(number)))
            shard.worker = lease->worker;
    }
    if (shard.state == "failed" || shard.state == "unfinished")
        shard.message = cluster::last_line_of(directory.shard_log(number));
    return shard;
}

StudyStatus status_of(const std::string& named) {
    StudyStatus status;
    status.directory = cluster::read_directory(named);
    const StudyDirectory& directory = status.directory;
    status.scheduler = cluster::find_scheduler(directory.scheduler);
    if (status.scheduler != nullptr && !cluster::is_there(*status.scheduler)) status.scheduler = nullptr;
    cluster::StudyQueue queue;
    try {
        if (status.scheduler != nullptr) queue = cluster::read_queue(*status.scheduler, directory);
    } catch (const std::runtime_error& error) {  // of a cluster that is down, or not set up here
        say(fmt::format("The queue cannot be asked, so only the files are known: {}", error.what()));
        status.scheduler = nullptr;
    }
    units::DiskFolder leases = directory.leases();
    const double now_s = leases.now_s();
    for (int number = 1; number <= directory.shards; ++number)
        status.shards.push_back(shard_status(status, queue, now_s, number));
    const bool merged = std::filesystem::exists(directory.merged_file());
    const bool begun = std::filesystem::exists(directory.merge_log());
    status.merge.state = state_of(merged, begun, queue.merge, status.scheduler != nullptr);
    if (!merged && units::is_held(leases, units::merge_lease, now_s)) status.merge.state = "running";
    status.merge.task = queue.merge;
    status.outlook = cluster::outlook_of(directory);
    return status;
}

// The state of the study, and what to do about it.
std::string advice(const StudyStatus& status) {
    const StudyDirectory& directory = status.directory;
    const std::string folder = directory.path.string();
    if (status.merge.state == "done" && directory.batch) {
        const auto problems = units::problems_of_results(read_file(directory.merged_file()));
        return problems.empty()
                   ? fmt::format("Complete, every answer has its hash: {}", directory.merged_file().string())
                   : fmt::format("Damaged: {}; remove {} and run `capstan study work {}`.", problems.front(),
                                 directory.merged_file().string(), folder);
    }
    if (status.merge.state == "done") {
        return fmt::format("Complete: capstan recommend --db {}", directory.merged_file().string());
    }
    if (directory.batch && status.scheduler == nullptr)
        return fmt::format("`capstan study work {}` goes on, on any machine that sees the folder.", folder);
    if (status.scheduler == nullptr)
        return fmt::format("There is no queue of {} on this machine, so only the files are known.",
                           directory.scheduler);
    bool left = status.merge.state == "failed" || status.merge.state == "not_started";
    for (const TaskStatus& shard : status.shards) {
        left = left || shard.state == "failed" || shard.state == "not_started";
    }
    if (!left) return "Running; nothing to do.";
    if (directory.batch)
        return fmt::format(
            "Some tasks are not in the queue. The logs in {0}/logs show why; submit them again with the same `capstan "
            "batch --directory {0}`.",
            folder);
    return fmt::format(
        "Some tasks are not in the queue. The logs in {0}/logs show why; submit them again with:\n"
        "capstan study submit --scheduler {3} {0}/config.toml --shards {1} --processors {2} --directory {0}",
        folder, directory.shards, directory.processors_per_shard, directory.scheduler);
}

std::string outlook_words(const StudyStatus& status) {
    const cluster::Outlook& outlook = status.outlook;
    if (outlook.mean_shard_s == 0.0 || status.merge.state == "done") return {};
    return fmt::format(
        " Left: {:.2g} core-hours, about {:.0f} s with {} at work.", outlook.left_core_h, outlook.left_s,
        outlook.running == 1 ? "1 worker" : fmt::format("{} workers", std::max(outlook.running, 1)));
}

Data task_data(const TaskStatus& task) {
    Data data = {{"state", task.state}};
    if (task.progress.units > 0) {
        data["units_done"] = task.progress.units_done;
        data["units"] = task.progress.units;
    }
    if (!task.progress.problem.empty()) data["problem"] = task.progress.problem;
    if (task.task) data["queue"] = {{"job", task.task->id}, {"state", task.task->state}};
    if (!task.worker.empty()) data["worker"] = task.worker;
    if (!task.message.empty()) data["message"] = task.message;
    return data;
}

reports::Answer answer_of(const StudyStatus& status) {
    Data shards = Data::list();
    int done = 0;
    for (std::size_t k = 0; k < status.shards.size(); ++k) {
        done += status.shards[k].progress.is_done() ? 1 : 0;
        Data shard = {{"shard", k + 1}};
        shard.update(task_data(status.shards[k]));
        shards.push_back(std::move(shard));
    }
    Data rows = shards;
    Data merge = {{"shard", "merge"}};
    merge.update(task_data(status.merge));
    rows.push_back(std::move(merge));
    reports::Answer answer{
        .id = "status",
        .kind = "A submitted study",
        .title = status.directory.name,
        .headline = fmt::format("{} of {} shards are done.{} {}", done, status.directory.shards,
                                outlook_words(status), advice(status))};
    answer.values = {{"name", status.directory.name},           {"directory", status.directory.path.string()},
                     {"scheduler", status.directory.scheduler}, {"knows_queue", status.scheduler != nullptr},
                     {"workers", status.outlook.running},       {"left_core_h", status.outlook.left_core_h},
                     {"left_s", status.outlook.left_s},         {"shards", shards},
                     {"merge", task_data(status.merge)}};
    answer.sections = {{.id = "shards",
                        .heading = "Shards in " + status.directory.path.string(),
                        .tables = {{"shards",
                                    "",
                                    {{"shard", "shard"},
                                     {"state", "state"},
                                     {"units_done", "units done"},
                                     {"units", "units"},
                                     {"worker", "worker"},
                                     {"queue.job", "job"},
                                     {"queue.state", "state in the queue"},
                                     {"message", "last message"},
                                     {"problem", "problem"}},
                                    rows}}}};
    return answer;
}

ExitCode run_study_status(const Invocation& invocation) {
    const StudyStatus status = status_of(invocation.argument("DIR"));
    deliver_answer(invocation, answer_of(status));
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
        .run = run_study_status};
}

namespace {

ExitCode run_study_work(const Invocation& invocation) {
    const StudyDirectory directory = cluster::read_directory(invocation.argument("DIR"));
    if (!directory.simd.empty())
        limit_simd(directory.simd, "the folder states --simd ");
    else
        use_stated_simd(invocation);
    std::optional<int> own;
    if (invocation.has("shard")) own = static_cast<int>(invocation.integer("shard"));
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
                     .low = 1,
                     .high = 1e6},
                    {.name = "merge",
                     .kind = OptionKind::flag,
                     .meaning = "Only join the shards, if that is not done."},
                    {.name = "late",
                     .kind = OptionKind::number,
                     .value = "SECONDS",
                     .meaning = "A shard is never late before that.",
                     .default_value = "30",
                     .low = 0,
                     .high = 1e9},
                    {.name = "jobs",
                     .letter = 'j',
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Number of threads, instead of the processors per task of the submission.",
                     .low = 0,
                     .high = 1024},
                    simd_option,
                    progress_option,
                    help_option},
        .examples = {"capstan study work atlas", "capstan study work atlas --shard 7"},
        .run = run_study_work,
        .when_stopped = "stopped by Ctrl-C or a request to terminate; the same command continues"};
}

}  // namespace capstan::cli
