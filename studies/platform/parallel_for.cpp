#include "capstan/platform/parallel_for.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace capstan {

void parallel_for_each_index(int count, int jobs, const std::function<void(int)>& body) {
    oneapi::tbb::task_arena arena(jobs > 0 ? jobs : oneapi::tbb::task_arena::automatic);
    arena.execute([&] { oneapi::tbb::parallel_for(0, count, body); });
}

}  // namespace capstan
