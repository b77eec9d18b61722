#include "long_call.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "capstan/platform/stop_request.h"

namespace capstan::python {

namespace {

using namespace std::chrono_literals;
constexpr auto between_signals = 40ms;
constexpr auto time_to_stop = 100ms;  // together below 0.2 s

class CallState final : public CallWatch {
  public:
    void run(std::function<void(CallWatch&)> work) {
        std::exception_ptr error;
        try {
            const StopScope scope(&stop_);
            work(*this);
        } catch (...) {
            error = std::current_exception();
        }
        work = nullptr;  // before anybody hears that it has ended
        const std::lock_guard lock(mutex_);
        error_ = error;
        is_done_ = true;
        ended_.notify_all();
    }

    bool wait_for(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        return ended_.wait_for(lock, time, [this] { return is_done_; });
    }

    void show_progress(const py::object& on_progress) {
        std::optional<Told> told;
        {
            const std::lock_guard lock(mutex_);
            told.swap(latest_);
        }
        if (told && !on_progress.is_none()) on_progress(told->activity, told->fraction);
    }

    void stop_now() { stop_ = true; }
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

  private:
    std::condition_variable ended_;
    bool is_done_ = false;
    std::exception_ptr error_;
};

struct RunningCall {
    std::shared_ptr<CallState> state;
    std::thread thread;
};

// Interrupted, and not yet at their ends. Only touched with the GIL.
std::vector<RunningCall>& interrupted_calls() {
    static std::vector<RunningCall> calls;
    return calls;
}

void forget_ended_calls() {
    std::erase_if(interrupted_calls(), [](RunningCall& call) {
        if (!call.state->wait_for(0ms)) return false;
        call.thread.join();
        return true;
    });
}

}  // namespace

void CallWatch::tell(const std::string& activity, double fraction) {
    const std::lock_guard lock(mutex_);
    latest_ = Told{activity, fraction};
}

void run_long_call(const py::object& on_progress, std::function<void(CallWatch&)> work) {
    forget_ended_calls();
    RunningCall call{std::make_shared<CallState>(), {}};
    call.thread =
        std::thread([state = call.state, work = std::move(work)]() mutable { state->run(std::move(work)); });
    try {
        for (bool is_done = false; !is_done;) {
            {
                const py::gil_scoped_release others_run;
                is_done = call.state->wait_for(between_signals);
            }
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            call.state->show_progress(on_progress);
        }
    } catch (...) {
        call.state->stop_now();
        {
            const py::gil_scoped_release others_run;
            call.state->wait_for(time_to_stop);
        }
        interrupted_calls().push_back(std::move(call));
        forget_ended_calls();
        throw;
    }
    call.thread.join();
    call.state->rethrow();
}

void wait_for_interrupted_calls() {
    std::vector<RunningCall> calls = std::move(interrupted_calls());
    interrupted_calls().clear();
    const py::gil_scoped_release others_run;
    for (RunningCall& call : calls) call.thread.join();
}

}  // namespace capstan::python
