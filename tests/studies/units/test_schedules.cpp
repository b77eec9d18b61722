#include <gtest/gtest.h>

#include "simulation.h"

namespace capstan::units {
namespace {

TEST(Schedules, LoseAndDoubleNoUnit) {
    for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
        const Schedule schedule = simulate(seed);
        EXPECT_EQ(schedule.problem, "") << "seed " << seed << ": " << schedule.kind;
    }
}

// Seeds that failed once, and why.
TEST(Schedules, ThatFailedOnceDoNotAgain) {
    constexpr std::uint64_t seeds[] = {
        93935,  // a bit of a record flipped in the key "computed_with": the merge took it for another
                // program's
        96106,  // the same in its value
        95241,  // the same where the record names a second worker's file
        50,     // a worker that waited beside a unit computed it, though it had ended just then
        55,
    };
    for (const std::uint64_t seed : seeds) EXPECT_EQ(simulate(seed).problem, "") << "seed " << seed;
}

TEST(Schedules, AreTheSameForTheSameSeed) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Schedule once = simulate(seed), again = simulate(seed);
        EXPECT_EQ(once.steps, again.steps);
        EXPECT_EQ(once.faults, again.faults);
    }
}

}  // namespace
}  // namespace capstan::units
