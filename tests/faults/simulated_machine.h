#pragma once
// Processes and their disk, as one seed draws them.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "failing_disk.h"
#include "simulated_system.h"

namespace capstan::faults {

// SplitMix64 (Steele, Lea, Flood 2014).
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
    bool one_in(int count) { return below(count) == 0; }

  private:
    std::uint64_t state_;
};

/// How a process ended.
struct Ended {
    int code = 0;      ///< its exit code
    std::string said;  ///< the message of what it threw
};

/// A machine with a folder, which is `root`, and processes that work in it one at a time.
class Machine {
  public:
    Machine(std::uint64_t seed, const std::filesystem::path& folder);

    Draws draws;
    SystemRun run;
    const std::filesystem::path root;

    /// What is to fail at a drawn operation of some `operations`.
    Planned some_fault(int operations);

    /// Runs `body` in a process of its own until it ends or stops; an exception is told and gives the exit
    /// code 3. Returns false if it stopped: it is then one of the halted.
    bool start(const Planned& planned, const std::function<void()>& body, Ended& ended);
    bool has_halted() const { return !halted_.empty(); }
    /// A drawn one goes on until it ends or stops again.
    bool go_on(Ended& ended);
    /// A drawn one is killed.
    void kill_one();
    void kill_one_if_any() {
        if (has_halted()) kill_one();
    }

    /// What is there now is on the disk.
    void sync_all();
    /// All processes are killed. Each block that was not synced, of a file whose name `takes`, is the new or
    /// the old one.
    void cut_power(const std::function<bool(const std::string&)>& takes);
    void flip_a_bit(const std::filesystem::path& file);

    /// The files below the root whose name `takes`, in the order of their names.
    std::vector<std::filesystem::path> files(const std::function<bool(const std::string&)>& takes) const;

  private:
    bool wait_for(pid_t process, Ended& ended);
    std::filesystem::path copy_of(const std::filesystem::path& path) const;

    const std::filesystem::path durable_, said_;
    std::vector<pid_t> halted_;
};

}  // namespace capstan::faults
