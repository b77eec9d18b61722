#pragma once

#include <functional>
#include <optional>
#include <string>

#include "capstan/cluster/study_directory.h"
#include "capstan/placement/study_run.h"

namespace capstan::cluster {

struct WorkOptions {
    RunOptions run;               ///< threads, progress and stop
    double late_after_s = 30.0;   ///< a shard is never late before that
    double late_factor = 3.0;     ///< nor before so many times as long as the median shard took
    std::string program_version;  ///< stored with the studies
    std::function<void(const std::string&)> say;  ///< a line of the log
};

/// Runs shards of the folder's study, each under a lease, so that any number of workers on any machines can
/// share it:
///
/// - with `own`: that shard, whoever held it before (a scheduler starts a task again when its node has
/// failed); without,
///   one free shard after the other;
/// - then, where every shard has been begun: waits beside one that runs, and computes it once more if it is
/// late or its
///   worker has died. Two workers on one shard write into two files with the same bits; the first that ends
///   counts;
/// - then, where every shard is done: joins them into study.db.
///
/// Of each unfinished shard only one worker waits. Returns stopped when options.run.stop was set.
RunEnd work(const StudyDirectory& directory, std::optional<int> own, const WorkOptions& options);

/// Joins the shards unless that is done; waits for a worker that joins them now. Throws storage::Error that
/// names what is missing.
RunEnd merge(const StudyDirectory& directory, const WorkOptions& options);

}  // namespace capstan::cluster
