#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/cluster/shard_record.h"
#include "capstan/cluster/study_queue.h"

namespace capstan::cluster {

/// How far a shard or the merge is.
struct TaskStatus {
    /// done, running, late, waiting, failed, not_started; without its scheduler also unfinished
    std::string state;
    ShardProgress progress;
    std::optional<QueuedTask> task;
    std::string worker;   ///< that holds its lease
    std::string message;  ///< the last line of the log of one that failed
};

/// A study in its folder, as its files, leases and queue tell.
struct StudyStatus {
    StudyDirectory directory;
    const Scheduler* scheduler = nullptr;  ///< null: it is not on this machine, or there is none
    std::string queue_problem;             ///< why the queue could not be asked
    std::vector<TaskStatus> shards;
    TaskStatus merge;
    Outlook outlook;
};

/// Throws std::runtime_error if the folder holds no submission.
StudyStatus status_of(const std::filesystem::path& folder);

/// The state of the study in a sentence, and what to do about it.
std::string advice(const StudyStatus& status);

}  // namespace capstan::cluster
