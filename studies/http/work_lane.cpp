#include "capstan/http/work_lane.h"

#include <unistd.h>

#include <cerrno>

namespace capstan::http {

WorkLane::WorkLane(const LaneLimits& limits) : limits_(limits) {
    for (int k = 0; k < limits_.threads; ++k) threads_.emplace_back([this] { work(); });
}

WorkLane::~WorkLane() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        waiting_.clear();
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

bool WorkLane::submit(Task task) {
    {
        const std::lock_guard lock(mutex_);
        if (ending_ || waiting_.size() >= limits_.waiting) return false;
        waiting_.push_back({std::move(task), Clock::now()});
    }
    changed_.notify_one();
    return true;
}

void WorkLane::work() {
    // On Linux each thread has a priority of its own.
    if (limits_.nice_increment != 0 && ::nice(limits_.nice_increment) == -1) errno = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
        if (ending_) return;
        Waiting next = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        next.task(Clock::now() - next.since > limits_.longest_wait ? Turn::too_late : Turn::now);
        next = {};
        lock.lock();
    }
}

}  // namespace capstan::http
