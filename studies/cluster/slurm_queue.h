#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// One task that Slurm has in its queue.
struct QueuedTask {
    std::string id;     ///< as 1234_7, for scancel and dependencies
    std::string state;  ///< Slurm's word: RUNNING, PENDING, ...

    bool is_running() const { return state == "RUNNING" || state == "COMPLETING"; }
};

/// What Slurm has of a study.
struct StudyQueue {
    std::map<int, QueuedTask> shards;  // by shard number
    std::optional<QueuedTask> merge;
};

/// Whether sbatch and squeue are on PATH.
bool slurm_is_there();

/// Throws std::runtime_error with what squeue said if it fails.
StudyQueue read_queue(const StudyDirectory& directory);

struct Submission {
    std::string array_job;    ///< empty: no shard had to be submitted
    std::string merge_job;    ///< empty: a merge was not needed, or waits already
    std::vector<int> shards;  ///< submitted now
};

/// Which shards are neither done nor in the queue.
std::vector<int> shards_to_submit(const StudyDirectory& directory, const StudyQueue& queue);

/// Submits those shards, and the merge after all that is in the queue then. An earlier merge that waits for
/// a failed shard is taken back. Throws std::runtime_error with what sbatch said if it fails; calling again
/// goes on.
Submission submit(const StudyDirectory& directory, const StudyQueue& queue);

}  // namespace capstan::cluster
