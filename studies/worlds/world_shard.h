#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/worlds/stored_worlds.h"

namespace capstan {

/// Whether the file holds a study over worlds, or a shard of one.
bool holds_worlds(storage::Database& database);

/// How far the file of a shard of a study over worlds is, in trials; nothing if it holds none.
struct WorldShardState {
    std::size_t trials_done = 0;
    std::size_t trials = 0;
};
std::optional<WorldShardState> read_world_shard_state(storage::Database& database);

/// Throws InvalidInput if one of so many shards would have no world to run.
void require_worlds_for(const StudyPlan& plan, int shards);

/// Runs one of `shard.shards` parts of a study over worlds in a file of its own, opened with
/// Journal::rollback; where the file is that part already, goes on where it was. A part is every so many
/// worlds: of a few sets all that the choice can ask for, of many sets the first look, which is most of the
/// work. Throws InvalidInput with problems_of(plan), storage::Error if the file is something else, and
/// TableStopped.
void run_world_shard(storage::Database& database, const StudyPlan& plan, const storage::ShardRecord& shard,
                     const std::string& program_version, const TableOptions& options);

/// Joins the files of all shards into a new database and completes the study: the same bits in every table
/// as one run. Under another name until it is complete. Throws storage::Error that names every missing,
/// doubled, foreign or unfinished shard, or says that `merged` exists already, and TableStopped.
void merge_world_shards(const std::filesystem::path& merged, const std::vector<std::filesystem::path>& shards,
                        const TableOptions& options);

}  // namespace capstan
