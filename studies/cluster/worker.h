#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "capstan/cluster/study_directory.h"
#include "capstan/placement/study_run.h"
#include "capstan/units/unit_worker.h"

namespace capstan::cluster {

struct WorkOptions {
    RunOptions run;               ///< threads, progress and stop
    double late_after_s = 30.0;   ///< a shard is never late before that
    double late_factor = 3.0;     ///< nor before so many times as long as the median shard took
    std::string program_version;  ///< stored with the studies
    std::function<void(const std::string&)> say;  ///< a line of the log
};

/// Runs shards of the folder as units::work() does, and merges them into StudyDirectory::merged_file().
/// Returns stopped when options.run.stop was set, and failed when a command of a batch failed here in a way
/// that may pass.
units::WorkEnd work(const StudyDirectory& directory, std::optional<int> own, const WorkOptions& options);

/// Joins the shards unless that is done; waits for a worker that joins them now. Throws storage::Error that
/// names what is missing.
units::WorkEnd merge(const StudyDirectory& directory, const WorkOptions& options);

/// While it lives, sets `stop` when the user asks for it, or when nobody wants the result.
class Watcher {
  public:
    Watcher(std::atomic<bool>& stop, const std::atomic<bool>* asked, std::function<bool()> is_unwanted);
    ~Watcher();
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

  private:
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

}  // namespace capstan::cluster
