#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace capstan::service {

/// A program that runs beside this one and dies with it: when this program is killed, by whatever means, so
/// is the child.
class ChildProcess {
  public:
    /// Starts `words[0]`, a path; standard output goes nowhere. Throws std::runtime_error if it cannot be
    /// started.
    explicit ChildProcess(const std::vector<std::string>& words);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Asks it to end, as Ctrl-C does; from any thread.
    void ask_to_stop() const;

    /// Hands over each line of its standard error as it comes, until it has ended. Returns its exit code; 128
    /// and the signal's number if it was killed.
    int wait(const std::function<void(const std::string& line)>& on_message);

  private:
    pid_t pid_ = -1;
    int messages_ = -1;  // reading end of a pipe
    std::atomic<bool> ended_{false};
};

}  // namespace capstan::service
