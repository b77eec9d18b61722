#pragma once

#include <string>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// The file with the shard's results: that of its record, or the one that bears its name.
std::filesystem::path file_of_shard(const StudyDirectory& directory, int shard);

/// What is left of a study, as far as the shards that are done tell.
struct Outlook {
    int done = 0;
    int running = 0;            ///< workers that hold a shard now
    double mean_shard_s = 0.0;  ///< wall time; 0: not known yet
    double left_core_h = 0.0;
    double left_s = 0.0;  ///< with as many workers as now, at least one
};
Outlook outlook_of(const StudyDirectory& directory);

/// The last line of a log that is not empty; empty if there is none.
std::string last_line_of(const std::filesystem::path& log);

}  // namespace capstan::cluster
