#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace capstan::python {

namespace py = pybind11;

/// What work and its caller tell each other.
class CallWatch {
  public:
    /// Set when the call is to stop.
    const std::atomic<bool>& stop() const { return stop_; }
    /// How far the work is; from any thread. The caller sees the latest.
    void tell(const std::string& activity, double fraction);

  protected:
    struct Told {
        std::string activity;
        double fraction = 0.0;
    };
    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::optional<Told> latest_;  ///< not yet seen by the caller
};

/// Runs `work` on a thread of its own, without the GIL and in a StopScope, and returns when it has ended.
/// Python meanwhile handles signals, and `on_progress(activity, fraction)` is called in the calling thread
/// where it is not None. Ctrl-C, and an exception of on_progress, come out here within 0.2 s: work that has
/// not stopped by then ends later and is ignored, so `work` must own what it uses and touch no Python object.
void run_long_call(const py::object& on_progress, std::function<void(CallWatch&)> work);

/// Waits for work that was interrupted; to be called before Python ends.
void wait_for_interrupted_calls();

}  // namespace capstan::python
