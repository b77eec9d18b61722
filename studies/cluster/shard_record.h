#pragma once

#include <optional>
#include <set>
#include <string>

#include "capstan/cluster/study_directory.h"

namespace capstan::cluster {

/// What a worker leaves when it has done a shard: leases/shard-3.done.
struct ShardRecord {
    std::string worker;    ///< host and process
    double seconds = 0.0;  ///< wall time
    std::string file;      ///< with its results, in the folder
};

/// What is in the folder of leases, by shard, with one look.
struct LeaseFolder {
    std::set<int> done;
    std::set<int> leased;  ///< by a worker that lives or died
};
LeaseFolder look_at_leases(const StudyDirectory& directory);

std::optional<ShardRecord> read_shard_record(const StudyDirectory& directory, int shard);
void write_shard_record(const StudyDirectory& directory, int shard, const ShardRecord& record);

/// The file with the shard's results: that of its record, or the one that bears its name.
std::filesystem::path file_of_shard(const StudyDirectory& directory, int shard);

/// Whether a worker has had the shard for longer than `after_s` and than `factor` times the median of the
/// first 99 shards that are done; never while none is.
bool is_late(const StudyDirectory& directory, int shard, double after_s, double factor);

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
