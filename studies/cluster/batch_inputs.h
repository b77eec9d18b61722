#pragma once

#include <string>
#include <vector>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// The inputs of a batch of `command`, as absolute paths: each of `named` is a file, or a folder whose
/// recordings (of `diagnose`) or configurations are taken in the order of their names; of `gap-trial` it is
/// the folder of one trial. Throws InvalidInput where there is none.
std::vector<std::string> batch_inputs(const std::string& command, const std::vector<std::string>& named);

/// One for each input; of a trial one for each of its recordings, which are sealed and not yet diagnosed.
/// Throws InvalidInput where the folder holds no sealed trial.
int shards_of(const Batch& batch);

}  // namespace capstan::cluster
