#include "capstan/platform/parallel_for.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>

#include "capstan/platform/stop_request.h"
#include "capstan/platform/work_meter.h"

namespace capstan {

thread_local const std::atomic<bool>* StopScope::stop_ = nullptr;

void parallel_for_each_index(int count, int jobs, const std::function<void(int)>& body) {
    using oneapi::tbb::global_control;
    // An arena alone never gets more threads than there are processors.
    std::optional<global_control> more_than_processors;
    if (jobs > oneapi::tbb::info::default_concurrency())
        more_than_processors.emplace(global_control::max_allowed_parallelism, static_cast<std::size_t>(jobs));
    oneapi::tbb::task_arena arena(jobs > 0 ? jobs : oneapi::tbb::task_arena::automatic);
    const std::atomic<bool>* const stop = StopScope::flag();
    WorkMeter* const meter = MeterScope::meter();
    arena.execute([&] {
        oneapi::tbb::parallel_for(0, count, [&](int index) {
            const StopScope same_work(stop);  // also where another thread runs the index
            const MeterScope same_meter(meter);
            throw_if_stopped();
            body(index);
        });
    });
}

}  // namespace capstan
