#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// The array job: task I runs shard I. Safe to run again at any moment, as after a node's failure.
std::string shards_script(const StudyDirectory& directory);

/// The job that joins the shards.
std::string merge_script(const StudyDirectory& directory);

/// "1-3,7" of ascending numbers, as sbatch --array wants them.
std::string as_array(const std::vector<int>& numbers);

/// One task in the queue of Slurm.
struct QueuedTask {
    std::string id;     ///< as 1234_7, for scancel and dependencies
    std::string state;  ///< Slurm's word: RUNNING, PENDING, ...

    bool is_running() const { return state == "RUNNING" || state == "COMPLETING"; }
};

/// The tasks of a study in the queue of Slurm.
struct StudyQueue {
    std::map<int, QueuedTask> shards;  // by shard number
    std::optional<QueuedTask> merge;
};

/// Whether sbatch and squeue are on PATH.
bool slurm_is_there();

/// Throws std::runtime_error with the message of squeue if it fails.
StudyQueue read_queue(const StudyDirectory& directory);

struct Submission {
    std::string array_job;    ///< empty: no shard had to be submitted
    std::string merge_job;    ///< empty: a merge was not needed or is already in the queue
    std::vector<int> shards;  ///< submitted now
};

/// The shards that are neither done nor in the queue.
std::vector<int> shards_to_submit(const StudyDirectory& directory, const StudyQueue& queue);

/// Submits those shards, and a merge that runs after every shard in the queue. An earlier merge that waits
/// for a failed shard is cancelled. Throws std::runtime_error with the message of sbatch if it fails; a
/// second call continues.
Submission submit(const StudyDirectory& directory, const StudyQueue& queue);

}  // namespace capstan::cluster
