#pragma once

#include <atomic>
#include <functional>
#include <mutex>

namespace capstan {

/// Counts the work of a command while it is done, in units that the work itself chooses, and hands on the
/// fraction that is done, which never falls. For any thread; what it hands on depends on nothing else, and no
/// result depends on it.
class WorkMeter {
  public:
    /// `show` is called by one thread at a time, some ten times a second at most.
    explicit WorkMeter(std::function<void(double fraction)> show);

    void expect(double units);
    void note(double units);
    /// Where the work shows only as it is done how much there is: this fraction of all of it is done.
    void replan(double fraction);

  private:
    void show();

    std::function<void(double)> show_;
    std::atomic<double> expected_{0.0};
    std::atomic<double> done_{0.0};
    std::atomic<double> next_show_s_{0.0};
    std::mutex mutex_;
    double shown_ = 0.0;
};

/// While it lives, this thread's work counts, and that of the loops of parallel_for_each_index() that it
/// begins. `meter` must outlive it; null counts nothing.
class MeterScope {
  public:
    explicit MeterScope(WorkMeter* meter) : outer_(meter_) { meter_ = meter; }
    ~MeterScope() { meter_ = outer_; }
    MeterScope(const MeterScope&) = delete;
    MeterScope& operator=(const MeterScope&) = delete;

    /// Of this thread's innermost scope; null outside of any.
    static WorkMeter* meter() { return meter_; }

  private:
    static thread_local WorkMeter* meter_;
    WorkMeter* outer_;
};

/// Units of work that will come.
inline void expect_work(double units) {
    if (MeterScope::meter() != nullptr) MeterScope::meter()->expect(units);
}

/// Units that are done.
inline void note_work(double units = 1.0) {
    if (MeterScope::meter() != nullptr) MeterScope::meter()->note(units);
}

}  // namespace capstan
