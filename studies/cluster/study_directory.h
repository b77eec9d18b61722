#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/units/shared_folder.h"
#include "capstan/units/unit_record.h"

namespace capstan::cluster {

/// Commands that run beside each other as the shards of a folder: one for each input.
struct Batch {
    std::string command;               ///< "diagnose"; empty: the folder is a study's
    std::vector<std::string> options;  ///< of each of them
    std::vector<std::string> inputs;   ///< absolute paths; of a trial, which is one folder: its cases

    /// What shard `number` runs with `processors`, after the program's name.
    std::vector<std::string> words(int number, int processors) const;

    bool operator==(const Batch&) const = default;
};

/// A folder in which a study is run in shards, or a batch of commands, on a disk that all machines of the
/// cluster see.
///
///     config.toml            the configuration, every key written out; a batch has none
///     submission.json        name, number of shards, processors of each, program
///     shards.sbatch          the array job; merge.sbatch the job that follows it (.sh of other schedulers
///     than Slurm) jobs.txt               the numbers of its jobs, of schedulers other than Slurm
///     shard-3-of-8.db        the results of shard 3; shard-3-of-8-by-HOST-PROCESS.db those of a second
///     worker logs/shard-3.log       its messages leases/shard-3.lease   who works on it; shard-3.done who
///     did study.db               the merged result; of a batch results.json, of its shards shard-3-of-8.json
struct StudyDirectory {
    std::filesystem::path path;  ///< absolute
    std::string name;            ///< of the study
    int shards = 1;
    int processors_per_shard = 1;
    std::filesystem::path program;    ///< capstan itself, absolute
    std::string scheduler = "slurm";  ///< as --scheduler takes it
    std::string simd;                 ///< vector instructions of all shards; empty: those of each machine
    std::optional<Batch> batch;       ///< nothing: it is a study
    int minutes_per_shard = 0;        ///< of wall time, asked of the scheduler; 0: its own default
    int megabytes_per_shard = 0;      ///< the same of memory

    std::filesystem::path config_file() const { return path / "config.toml"; }
    std::filesystem::path submission_file() const { return path / "submission.json"; }
    std::filesystem::path shards_script() const { return path / ("shards" + script_ending()); }
    std::filesystem::path merge_script() const { return path / ("merge" + script_ending()); }
    std::filesystem::path jobs_file() const { return path / "jobs.txt"; }
    std::filesystem::path shard_file(int number) const;
    std::filesystem::path shard_log(int number) const;
    std::filesystem::path second_file(int number, const std::string& worker) const;

    std::filesystem::path leases_folder() const { return path / "leases"; }
    units::DiskFolder leases() const { return units::DiskFolder(leases_folder()); }
    std::filesystem::path merge_log() const { return path / "logs/merge.log"; }
    std::filesystem::path merged_file() const { return path / (batch ? "results.json" : "study.db"); }
    /// Slurm's name of the array job, found again by it; that of the merge ends in "-merge".
    std::string job_name() const;

  private:
    std::string script_ending() const { return scheduler == "slurm" ? ".sbatch" : ".sh"; }
    std::filesystem::path result_file(int number, const std::string& before_ending) const;
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
