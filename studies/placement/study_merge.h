#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capstan/placement/study_run.h"
#include "capstan/placement/study_shard.h"

namespace capstan {

/// How far a shard's file is.
struct ShardState {
    Shard shard;
    int units_done = 0;
    int units = 0;  ///< of the shard, not of the study

    bool is_done() const { return units_done == units; }
};

/// Reads a file that run_shard() wrote; nothing if the file holds no shard. Throws storage::Error if it
/// cannot be read.
std::optional<ShardState> read_shard_state(storage::Database& database);

/// Joins the files of all shards into a new database with the same bits in every table as one run would have
/// given. Under another name (`merged` + ".unfinished") until it is complete. Throws storage::Error that
/// names every missing, doubled, foreign or unfinished shard, or says that `merged` exists already.
RunEnd merge_shards(const std::filesystem::path& merged, const std::vector<std::filesystem::path>& shards,
                    const RunOptions& options);

}  // namespace capstan
