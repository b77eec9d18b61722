#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace capstan::http {

/// How much of one kind of work is done at once.
struct LaneLimits {
    int threads = 4;
    std::size_t waiting = 256;              ///< tasks; further ones are refused
    std::chrono::seconds longest_wait{10};  ///< for a thread; a task that waited longer is told so
    int nice_increment = 0;                 ///< of its threads
};

/// Threads for one kind of work: slow work of one kind never keeps that of another waiting.
class WorkLane {
  public:
    enum class Turn { now, too_late };
    using Task = std::function<void(Turn)>;

    explicit WorkLane(const LaneLimits& limits);
    /// Forgets what waits, and waits for what is being done.
    ~WorkLane();
    WorkLane(const WorkLane&) = delete;
    WorkLane& operator=(const WorkLane&) = delete;

    /// False if too many tasks wait already.
    bool submit(Task task);

  private:
    using Clock = std::chrono::steady_clock;
    struct Waiting {
        Task task;
        Clock::time_point since;
    };

    void work();

    LaneLimits limits_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Waiting> waiting_;
    bool ending_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace capstan::http
