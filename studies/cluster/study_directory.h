#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/placement/study_shard.h"

namespace capstan::cluster {

/// A folder in which a study is run in shards, on a disk that all machines of the cluster see.
///
///     config.toml            the configuration, every key written out
///     submission.json        name, number of shards, processors of each, program
///     shards.sbatch          the array job; merge.sbatch the job that follows it
///     shard-3-of-8.db        the results of shard 3
///     logs/shard-3.log       its messages
///     study.db               the merged result
struct StudyDirectory {
    std::filesystem::path path;  ///< absolute
    std::string name;            ///< of the study
    int shards = 1;
    int processors_per_shard = 1;
    std::filesystem::path program;  ///< capstan itself, absolute

    std::filesystem::path config_file() const { return path / "config.toml"; }
    std::filesystem::path submission_file() const { return path / "submission.json"; }
    std::filesystem::path shards_script() const { return path / "shards.sbatch"; }
    std::filesystem::path merge_script() const { return path / "merge.sbatch"; }
    std::filesystem::path shard_file(int number) const;
    std::filesystem::path shard_log(int number) const;
    std::filesystem::path merge_log() const { return path / "logs/merge.log"; }
    std::filesystem::path merged_file() const { return path / "study.db"; }
    /// Slurm's name of the array job, found again by it; that of the merge ends in "-merge".
    std::string job_name() const;
};

std::string submission_text(const StudyDirectory& directory);

/// Throws std::runtime_error that says what to try if the folder holds no submission.
StudyDirectory read_directory(const std::filesystem::path& path);

/// The progress of a shard, from its file and log alone.
struct ShardProgress {
    int units_done = 0;
    int units = 0;           ///< 0: unknown, because the file does not exist yet
    bool was_begun = false;  ///< it left a file or a log
    std::string problem;     ///< why its file cannot be read now; a task may be writing it

    bool is_done() const { return units > 0 && units_done == units; }
};

ShardProgress progress_of(const StudyDirectory& directory, int number);

}  // namespace capstan::cluster
