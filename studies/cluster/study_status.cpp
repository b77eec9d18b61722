#include "capstan/cluster/study_status.h"

#include <fmt/format.h>

#include "capstan/cluster/worker.h"
#include "capstan/platform/files.h"
#include "capstan/units/lease.h"
#include "capstan/units/result_units.h"
#include "capstan/units/unit_record.h"

namespace capstan::cluster {

namespace {

std::string state_of(bool is_done, bool was_begun, const std::optional<QueuedTask>& task, bool knows_queue) {
    if (is_done) return "done";
    if (task) return task->is_running() ? "running" : "waiting";
    if (!was_begun) return "not_started";
    return knows_queue ? "failed" : "unfinished";
}

TaskStatus shard_status(const StudyStatus& status, const StudyQueue& queue, double now_s, int number) {
    const StudyDirectory& directory = status.directory;
    const WorkOptions usual;
    TaskStatus shard;
    shard.progress = progress_of(directory, number);
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
        shard.message = last_line_of(directory.shard_log(number));
    return shard;
}

}  // namespace

StudyStatus status_of(const std::filesystem::path& folder) {
    StudyStatus status;
    status.directory = read_directory(folder);
    const StudyDirectory& directory = status.directory;
    status.scheduler = find_scheduler(directory.scheduler);
    if (status.scheduler != nullptr && !is_there(*status.scheduler)) status.scheduler = nullptr;
    StudyQueue queue;
    try {
        if (status.scheduler != nullptr) queue = read_queue(*status.scheduler, directory);
    } catch (const std::runtime_error& error) {  // of a cluster that is down, or not set up here
        status.queue_problem = error.what();
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
    status.outlook = outlook_of(directory);
    return status;
}

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

}  // namespace capstan::cluster
