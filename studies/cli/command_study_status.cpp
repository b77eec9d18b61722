#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cluster/slurm_queue.h"

namespace capstan::cli {

namespace {

using cluster::QueuedTask;
using cluster::StudyDirectory;
using reports::Data;

// State of a shard or of the merge.
struct TaskStatus {
    std::string state;  // done, running, waiting, failed, not_started; without Slurm also unfinished
    cluster::ShardProgress progress;
    std::optional<QueuedTask> task;
};

struct StudyStatus {
    StudyDirectory directory;
    bool slurm = false;
    std::vector<TaskStatus> shards;
    TaskStatus merge;
};

std::string state_of(bool is_done, bool was_begun, const std::optional<QueuedTask>& task, bool slurm) {
    if (is_done) return "done";
    if (task) return task->is_running() ? "running" : "waiting";
    if (!was_begun) return "not_started";
    return slurm ? "failed" : "unfinished";
}

StudyStatus status_of(const std::string& named) {
    StudyStatus status{cluster::read_directory(named), cluster::slurm_is_there(), {}, {}};
    const StudyDirectory& directory = status.directory;
    const cluster::StudyQueue queue = status.slurm ? cluster::read_queue(directory) : cluster::StudyQueue{};
    for (int number = 1; number <= directory.shards; ++number) {
        TaskStatus shard{{}, cluster::progress_of(directory, number), {}};
        if (const auto task = queue.shards.find(number); task != queue.shards.end())
            shard.task = task->second;
        shard.state = state_of(shard.progress.is_done(), shard.progress.was_begun, shard.task, status.slurm);
        status.shards.push_back(std::move(shard));
    }
    const bool merged = std::filesystem::exists(directory.merged_file());
    const bool begun = std::filesystem::exists(directory.merge_log());
    status.merge.state = state_of(merged, begun, queue.merge, status.slurm);
    status.merge.task = queue.merge;
    return status;
}

// The state of the study, and what to do about it.
std::string advice(const StudyStatus& status) {
    const StudyDirectory& directory = status.directory;
    const std::string folder = directory.path.string();
    if (status.merge.state == "done") {
        return fmt::format("Complete: capstan recommend --db {}", directory.merged_file().string());
    }
    if (!status.slurm) return "There is no Slurm on this machine, so only the files are known.";
    bool left = status.merge.state == "failed" || status.merge.state == "not_started";
    for (const TaskStatus& shard : status.shards) {
        left = left || shard.state == "failed" || shard.state == "not_started";
    }
    if (!left) return "Running; nothing to do.";
    return fmt::format(
        "Some tasks are not in the queue. The logs in {0}/logs show why; submit them again with:\n"
        "capstan study submit --slurm {0}/config.toml --shards {1} --processors {2} --directory {0}",
        folder, directory.shards, directory.processors_per_shard);
}

Data task_data(const TaskStatus& task) {
    Data data = {{"state", task.state}};
    if (task.progress.units > 0) {
        data["units_done"] = task.progress.units_done;
        data["units"] = task.progress.units;
    }
    if (!task.progress.problem.empty()) data["problem"] = task.progress.problem;
    if (task.task) data["slurm"] = {{"job", task.task->id}, {"state", task.task->state}};
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
    reports::Answer answer{.id = "status",
                           .kind = "A submitted study",
                           .title = status.directory.name,
                           .headline = fmt::format("{} of {} shards are done. {}", done,
                                                   status.directory.shards, advice(status))};
    answer.values = {{"name", status.directory.name},
                     {"directory", status.directory.path.string()},
                     {"slurm", status.slurm},
                     {"shards", shards},
                     {"merge", task_data(status.merge)}};
    answer.sections = {{.id = "shards",
                        .heading = "Shards in " + status.directory.path.string(),
                        .tables = {{"shards",
                                    "",
                                    {{"shard", "shard"},
                                     {"state", "state"},
                                     {"units_done", "units done"},
                                     {"units", "units"},
                                     {"slurm.job", "Slurm job"},
                                     {"slurm.state", "Slurm state"},
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
            "Shows for every shard in a folder made by `capstan study submit` whether it is done, "
            "running, waiting, failed (started, but not in Slurm's queue) or not started, how many of "
            "its units are stored, and its state in Slurm; then shows what to do next. It reads the "
            "shards' files and also works without Slurm.",
        .arguments = {{"DIR", "The study's folder.", ArgumentNeed::optional, "capstan-study"}},
        .options = {output_option, json_option, help_option},
        .examples = {"capstan study status atlas", "capstan study status atlas --json | jq -r .merge.state"},
        .run = run_study_status};
}

}  // namespace capstan::cli
