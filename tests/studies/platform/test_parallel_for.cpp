#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "capstan/platform/parallel_for.h"
#include "capstan/platform/stop_request.h"

namespace capstan {
namespace {

// Whether 7 and 16 threads give the same bits can only be tested where they run at once, whatever the
// processors.
TEST(ParallelFor, RunsAsManyThreadsAtOnceAsJobs) {
    for (const int jobs : {2, 7, 16}) {
        std::atomic<int> inside{0};
        std::atomic<bool> all_met{false};
        std::atomic<int> most{0};
        parallel_for_each_index(8 * jobs, jobs, [&](int) {
            const int now = ++inside;
            for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) continue;
            if (now == jobs) all_met = true;
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
            while (!all_met && std::chrono::steady_clock::now() < end) std::this_thread::yield();
            --inside;
        });
        EXPECT_TRUE(all_met) << jobs;
        EXPECT_EQ(most, jobs);
    }
}

TEST(ParallelFor, CallsEachIndexOnce) {
    std::vector<int> calls(1000, 0);
    parallel_for_each_index(1000, 0, [&](int index) { ++calls[static_cast<std::size_t>(index)]; });
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
}

TEST(ParallelFor, BeginsNoIndexAfterAStop) {
    std::atomic<bool> stop{false};
    std::atomic<int> calls{0};
    const StopScope scope(&stop);
    EXPECT_THROW(parallel_for_each_index(1000000, 2,
                                         [&](int) {
                                             ++calls;
                                             stop = true;
                                         }),
                 WorkStopped);
    EXPECT_LE(calls, 2);  // one on each thread
}

TEST(ParallelFor, AStopReachesLoopsWithinLoopsOnOtherThreads) {
    std::atomic<bool> stop{false};
    std::atomic<int> inner_calls{0};
    const StopScope scope(&stop);
    EXPECT_THROW(parallel_for_each_index(4, 4,
                                         [&](int) {
                                             parallel_for_each_index(1000000, 1, [&](int) {
                                                 ++inner_calls;
                                                 stop = true;
                                             });
                                         }),
                 WorkStopped);
    EXPECT_LE(inner_calls, 4);
}

TEST(ParallelFor, AStopOfOneThreadsWorkLeavesOtherWorkAlone) {
    const std::atomic<bool> stop{true};
    {
        const StopScope scope(&stop);
        EXPECT_THROW(throw_if_stopped(), WorkStopped);
    }
    int calls = 0;
    parallel_for_each_index(3, 1, [&](int) { ++calls; });
    EXPECT_EQ(calls, 3);
    const StopScope scope(&stop);
    const StopScope none(nullptr);
    EXPECT_NO_THROW(throw_if_stopped());
}

}  // namespace
}  // namespace capstan
