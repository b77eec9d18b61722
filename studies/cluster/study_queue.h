#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/cluster/scheduler.h"

namespace capstan::cluster {

/// One task in a scheduler's queue.
struct QueuedTask {
    std::string id;     ///< as 1234_7 of Slurm; of the others the job's
    std::string state;  ///< Slurm's word: RUNNING, PENDING, ...; of the others QUEUED

    bool is_running() const { return state == "RUNNING" || state == "COMPLETING"; }
};

/// The tasks of a study in the queue. Slurm's are found again by their name; of the others the folder keeps
/// the numbers of the jobs, and all unfinished tasks of a job count as queued while it is.
struct StudyQueue {
    std::map<int, QueuedTask> shards;  // by shard number
    std::optional<QueuedTask> merge;
};

/// Throws std::runtime_error with the message of the scheduler if it fails.
StudyQueue read_queue(const Scheduler& scheduler, const StudyDirectory& directory);

struct ArrayOptions {
    int limit = 0;     ///< the largest index of an array; 0: what the cluster says
    int throttle = 0;  ///< tasks at a time; 0: no limit
};

/// The calls of a submission, without making them: the arrays, and the merge with JOB in the place of their
/// numbers.
std::vector<std::vector<std::string>> planned_calls(const Scheduler& scheduler,
                                                    const StudyDirectory& directory,
                                                    const std::vector<int>& shards,
                                                    const ArrayOptions& options);

struct Submission {
    std::vector<std::string> array_jobs;  ///< empty: no shard had to be submitted
    std::string merge_job;                ///< empty: a merge was not needed or is already in the queue
    std::vector<int> shards;              ///< submitted now
};

/// The shards that are neither done nor in the queue.
std::vector<int> shards_to_submit(const StudyDirectory& directory, const StudyQueue& queue);

/// Submits those shards, and a merge that runs after every shard in the queue. An earlier merge that waits
/// for a failed shard is cancelled. Throws std::runtime_error with the message of the scheduler if it fails;
/// a second call continues.
Submission submit(const Scheduler& scheduler, const StudyDirectory& directory, const StudyQueue& queue,
                  const ArrayOptions& options);

}  // namespace capstan::cluster
