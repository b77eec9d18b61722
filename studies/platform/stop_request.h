#pragma once

#include <atomic>

namespace capstan {

/// Thrown from a loop over threads that was asked to stop.
struct WorkStopped {};

/// While it lives, the loops of parallel_for_each_index() that this thread begins, and the loops within
/// those, end with WorkStopped soon after `stop` is set: no further index is begun. `stop` must outlive it;
/// null lets the loops run to their ends.
class StopScope {
  public:
    explicit StopScope(const std::atomic<bool>* stop) : outer_(stop_) { stop_ = stop; }
    ~StopScope() { stop_ = outer_; }
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

    /// The flag of this thread's innermost scope; null outside of any.
    static const std::atomic<bool>* flag() { return stop_; }

  private:
    static thread_local const std::atomic<bool>* stop_;
    const std::atomic<bool>* outer_;
};

/// Throws WorkStopped if this thread was asked to stop.
inline void throw_if_stopped() {
    if (StopScope::flag() != nullptr && StopScope::flag()->load(std::memory_order_relaxed))
        throw WorkStopped();
}

}  // namespace capstan
