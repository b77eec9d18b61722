#include <gtest/gtest.h>

#include "capstan/gap/candidate_cause.h"

namespace capstan::gap {
namespace {

TEST(OpenNumber, IsAtABoundWhereItsSearchEnded) {
    const OpenNumber exponent{"n", "", OpenNumber::Kind::shape, 1.0, 1.0, 0.2, 3.0};
    EXPECT_FALSE(exponent.is_at_bound(exponent.value(0.5)));
    EXPECT_TRUE(exponent.is_at_bound(exponent.value(10.0)));
    EXPECT_TRUE(exponent.is_at_bound(exponent.value(-10.0)));
}

TEST(OpenNumber, IsNotAtABoundWhereTheCauseIsAbsent) {
    const OpenNumber drag{"drag", "N s/m2", OpenNumber::Kind::size, 2.0, 0.0, 0.0, 50.0};
    EXPECT_FALSE(drag.is_at_bound(drag.value(0.0)));
    EXPECT_TRUE(drag.is_at_bound(drag.value(100.0)));
}

TEST(FloatingNumber, IsAtABoundBeyondWhatABenchCanHave) {
    const FloatingNumber& pretension = measured_bench().numbers[2];
    EXPECT_FALSE(pretension.is_at_bound(0.3));
    EXPECT_TRUE(pretension.is_at_bound(-5.0));
    EXPECT_TRUE(pretension.is_at_bound(3.0));
}

}  // namespace
}  // namespace capstan::gap
