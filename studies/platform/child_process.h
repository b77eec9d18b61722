#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace capstan {

/// How a program ended and what it wrote.
struct CommandOutput {
    int exit_code = 0;     ///< 128 and the signal's number if a signal ended it
    std::string output;    ///< standard output
    std::string messages;  ///< standard error; empty if its lines were handed over
    bool is_late = false;  ///< it was killed, because its time was up or it was no longer wanted
    bool is_long = false;  ///< it was killed, because it wrote too much
};

/// What the system lets a program have. Zero: no limit.
struct ChildLimits {
    int nice_increment = 0;
    std::size_t memory_bytes = 0;  ///< of its address space
    int processor_s = 0;           ///< of processor time
};

/// How long a program is waited for. When one of these is exceeded, it is killed.
struct Patience {
    std::optional<std::chrono::milliseconds> longest{};
    std::size_t max_output_bytes = std::numeric_limits<std::size_t>::max();
    const std::atomic<bool>* unwanted = nullptr;  ///< kills it when it becomes true
};

/// A program that runs beside this one, without a shell, and dies with it: when this program is killed, by
/// whatever means, so is the child.
class ChildProcess {
  public:
    /// Starts `command_line[0]`, a path or a name that is on PATH. Throws std::runtime_error if it cannot be
    /// started. The thread that constructs it must live until the child ends.
    explicit ChildProcess(const std::vector<std::string>& command_line, const ChildLimits& limits = {});
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Asks it to end, as Ctrl-C does; from any thread.
    void ask_to_stop() const;

    /// Reads what the program writes until it has ended. Each line of its standard error goes to
    /// `on_error_line` as it comes, if there is one.
    CommandOutput wait(const std::function<void(const std::string& line)>& on_error_line = {},
                       const Patience& patience = {});

  private:
    pid_t pid_ = -1;
    int output_ = -1;  // reading ends of pipes
    int messages_ = -1;
    std::atomic<bool> ended_{false};
};

CommandOutput run_command(const std::vector<std::string>& command_line, const ChildLimits& limits = {},
                          const Patience& patience = {});

bool is_on_path(const std::string& program);

}  // namespace capstan
