#pragma once

#include <string>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// The array job: task I runs shard I. Safe to run again at any moment, as after a node's failure.
std::string shards_script(const StudyDirectory& directory);

/// The job that joins the shards.
std::string merge_script(const StudyDirectory& directory);

/// "1-3,7" of ascending numbers, as sbatch --array wants them.
std::string as_array(const std::vector<int>& numbers);

}  // namespace capstan::cluster
