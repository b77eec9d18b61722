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
///     shards.sbatch          the array job; merge.sbatch the job that follows it (.sh of other schedulers
///     than Slurm) jobs.txt               the numbers of its jobs, of schedulers other than Slurm
///     shard-3-of-8.db        the results of shard 3; shard-3-of-8-by-HOST-PROCESS.db those of a second
///     worker logs/shard-3.log       its messages leases/shard-3.lease   who works on it; shard-3.done who
///     did study.db               the merged result
struct StudyDirectory {
    std::filesystem::path path;  ///< absolute
    std::string name;            ///< of the study
    int shards = 1;
    int processors_per_shard = 1;
    std::filesystem::path program;    ///< capstan itself, absolute
    std::string scheduler = "slurm";  ///< as --scheduler takes it
    std::string simd;                 ///< vector instructions of all shards; empty: those of each machine

    std::filesystem::path config_file() const { return path / "config.toml"; }
    std::filesystem::path submission_file() const { return path / "submission.json"; }
    std::filesystem::path shards_script() const { return path / ("shards" + script_ending()); }
    std::filesystem::path merge_script() const { return path / ("merge" + script_ending()); }
    std::filesystem::path jobs_file() const { return path / "jobs.txt"; }
    std::filesystem::path shard_file(int number) const;
    std::filesystem::path shard_log(int number) const;
    std::filesystem::path second_file(int number, const std::string& worker) const;

    std::filesystem::path leases_folder() const { return path / "leases"; }
    std::filesystem::path lease_file(int number) const { return in_leases(number, ".lease"); }
    std::filesystem::path second_lease_file(int number) const { return in_leases(number, ".second"); }
    std::filesystem::path standby_file(int number) const { return in_leases(number, ".standby"); }
    std::filesystem::path done_file(int number) const { return in_leases(number, ".done"); }
    std::filesystem::path merge_lease_file() const { return leases_folder() / "merge.lease"; }
    std::filesystem::path merge_log() const { return path / "logs/merge.log"; }
    std::filesystem::path merged_file() const { return path / "study.db"; }
    /// Slurm's name of the array job, found again by it; that of the merge ends in "-merge".
    std::string job_name() const;

  private:
    std::string script_ending() const { return scheduler == "slurm" ? ".sbatch" : ".sh"; }
    std::filesystem::path in_leases(int number, const std::string& ending) const {
        return leases_folder() / ("shard-" + std::to_string(number) + ending);
    }
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
