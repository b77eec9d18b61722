#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// Shards that are submitted in one call: task k of the array runs shard `offset` + k.
struct ShardArray {
    int offset = 0;
    std::vector<int> tasks;  ///< rising, from 1
};

/// The shards in arrays whose largest index is `limit`. Where a scheduler takes no lists, an array has
/// consecutive tasks.
std::vector<ShardArray> arrays_of(const std::vector<int>& shards, int limit, bool takes_lists);

/// "1-3,7" of ascending numbers, as --array wants them.
std::string as_array(const std::vector<int>& numbers);

/// Another scheduler is another row in scheduler.cpp: how it is told what to do, and what it answers.
struct Scheduler {
    std::string_view name;   ///< as --scheduler takes it
    std::string_view title;  ///< for people
    std::string_view submit_program;
    std::string_view status_program;  ///< both must be on PATH
    std::string_view cancel_program;  ///< takes a job's id
    std::string_view task_variable;   ///< of the environment of a task: its index in the array
    int array_limit = 0;              ///< the largest index, where the cluster does not say
    bool takes_lists = false;         ///< "1-3,7" in one array

    /// Lines of a script's head: name, log, processors, folder.
    std::string (*directives)(const StudyDirectory& directory, const std::string& job, const std::string& log,
                              int processors) = nullptr;

    /// The call that submits an array. `throttle`: tasks at a time; 0: no limit.
    std::vector<std::string> (*submission)(const StudyDirectory& directory, const ShardArray& array,
                                           int throttle) = nullptr;

    /// The call that submits the merge, which begins when these jobs have ended.
    std::vector<std::string> (*merge_submission)(const StudyDirectory& directory,
                                                 std::span<const std::string> jobs) = nullptr;

    /// The job's id in the answer to a submission.
    std::string (*job_id)(const std::string& answer) = nullptr;

    /// A call that succeeds while the job is in the queue.
    std::vector<std::string> (*question)(const std::string& job) = nullptr;
};


/// Null: there is none of that name.
const Scheduler* find_scheduler(std::string_view name);

bool is_there(const Scheduler& scheduler);

/// The largest array index of this cluster: `stated`, what the scheduler says (Slurm's MaxArraySize less
/// one), or its default. `stated` 0: not stated.
int array_limit_of(const Scheduler& scheduler, int stated);

/// Task I of an array runs shard I + its first argument. Safe to run again at any moment, as after a node's
/// failure.
std::string shards_script(const Scheduler& scheduler, const StudyDirectory& directory);

/// The job that joins the shards, where no worker has done it.
std::string merge_script(const Scheduler& scheduler, const StudyDirectory& directory);

}  // namespace capstan::cluster
