#pragma once

#include <string>
#include <vector>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

// Ways to run the shards of a study without a queue of jobs, by programs that distribute work themselves.
// Each calls `capstan study work`, whose leases keep two workers from the same shard.

/// Starts a worker on a host that sees the folder under the same path, and returns.
std::vector<std::string> ssh_call(const StudyDirectory& directory, const std::string& host);

/// A script that runs every shard with GNU parallel, `throttle` at a time on each of the hosts; 0: one per
/// processor.
std::string parallel_script(const StudyDirectory& directory, const std::vector<std::string>& hosts,
                            int throttle);

/// A workflow of Snakemake, for its local cores, --slurm, --cluster and --kubernetes.
std::string snakemake_workflow(const StudyDirectory& directory);

}  // namespace capstan::cluster
