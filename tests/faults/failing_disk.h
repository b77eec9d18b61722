#pragma once
// Stands between this process and the disk: counts its writes, syncs, truncations, links, renames and
// removals of files, and lets one of them fail, or stops or ends the process there. Linked into a program, so
// that SQLite and every room use it.

#include <filesystem>

namespace capstan::faults {

enum class Fault {
    none,
    error,       ///< EIO, once
    full,        ///< ENOSPC, from then on
    torn,        ///< half is written, then the process is killed
    kill,        ///< before the operation
    kill_after,  ///< after it
    stop,        ///< SIGSTOP: others work before it goes on
};

struct Planned {
    Fault fault = Fault::none;
    long at = 0;                   ///< number of the operation, from 1
    bool stops_in_pauses = false;  ///< whoever waits for others stops too, instead of sleeping
};

constexpr int killed_code = 137;

/// From now on, in this process. What is synced is copied below `durable`, under the same name as below
/// `root`.
void arm(const Planned& planned, const std::filesystem::path& root, const std::filesystem::path& durable);

/// How many operations there were.
long operations();

}  // namespace capstan::faults
