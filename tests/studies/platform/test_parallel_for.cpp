#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "capstan/platform/parallel_for.h"
#include "capstan/platform/stop_request.h"

namespace capstan {
namespace {

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
