#pragma once

#include <chrono>
#include <ctime>

namespace capstan {

/// Processor time [s] that the calling thread has used so far. A call costs most of a microsecond.
inline double thread_processor_time_s() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Time [s] since some fixed moment. A call is cheap.
inline double wall_time_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace capstan
