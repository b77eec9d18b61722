#pragma once

#include <string>
#include <vector>

#include "capstan/cluster/scheduler.h"
#include "capstan/cluster/study_directory.h"
#include "capstan/cluster/study_queue.h"

namespace capstan::cluster {

/// What is to be submitted, and how.
struct Request {
    StudyDirectory directory;
    const Scheduler* scheduler = nullptr;  ///< null: one of the ways without a queue, or none
    ArrayOptions arrays;
    std::vector<std::string> hosts;  ///< of ssh and GNU parallel
};

/// Writes the folder: the configuration (empty: there is none), the scripts, and last submission.json, which
/// marks a complete folder.
void write_folder(const Request& request, const std::string& config_toml);

/// Submits the shards that are neither done nor in the queue, or starts workers where there is no queue.
/// Returns what was done, for people.
std::string submit_request(const Request& request);

/// The scripts and the calls that submit_request() would make.
std::string planned_request(const Request& request);

}  // namespace capstan::cluster
