#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace capstan::faults {

/// What one seed gave.
struct SystemRun {
    std::string problem{};  ///< empty: every result is there once, with its bits
    std::string kind{};     ///< what the seed drew, for people
    int processes = 0;      ///< that were started
    int faults = 0;         ///< that met one of them
};

/// One small study, computed once without any fault: its configuration, and the hash of its results.
struct Reference {
    std::string config_toml;
    std::string hash;
};
Reference reference(const std::filesystem::path& folder);

/// A study in shards from its folder to the merged database: the real workers, leases and merge, each worker
/// in a process of its own, on real files. The seed draws who works when, and what fails: an operation on the
/// disk (EIO, a full disk, half a write), a kill or a halt before or after it, a power cut that loses what
/// was not synced, a bit that flips in a file of a shard, a lease or a record, a worker that is not heard of
/// for minutes. From some time on nothing fails any more, and whoever runs the study does what the messages
/// say; then the result must come, with its hashes.
SystemRun simulate_study(std::uint64_t seed, const Reference& reference, const std::filesystem::path& folder);

/// The queue of the service in a process of its own, with `program` as the jobs' program: killed at any
/// operation on the disk and started again, with power cuts and a full disk; and programs of jobs whose disk
/// fails. Every job that was acknowledged must then be done once, with the results of `reference`.
SystemRun simulate_queue(std::uint64_t seed, const Reference& reference, const std::filesystem::path& program,
                         const std::filesystem::path& shim, const std::filesystem::path& folder);

}  // namespace capstan::faults
