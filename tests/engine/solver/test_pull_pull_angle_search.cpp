// The search for a pulley's angle, on torques nastier than two cables'.
#include <gtest/gtest.h>

#include <cmath>

#include "capstan/solver/pull_pull_angle_search.h"

namespace capstan {
namespace {

TEST(AngleSearch, EndsAtAJumpWithTheResidual) {
    const auto jumps = [](double angle_rad) { return angle_rad < 0.3 ? -1.0 : 2.0; };
    const AngleSearch search = search_angle({0.0, 10.0}, jumps);
    EXPECT_FALSE(search.converged);
    EXPECT_TRUE(search.at_jump);
    EXPECT_NEAR(search.angle_rad, 0.3, 1e-12);
    EXPECT_EQ(search.torque_residual_Nm, -1.0) << "the side that is less wrong";
}

TEST(AngleSearch, StopsWhereTheTorqueCannotBeReached) {
    double last_tried_rad = 1.0;
    const AngleSearch search = search_angle({0.5, 10.0}, [&](double angle_rad) {
        last_tried_rad = angle_rad;
        return -1.0;
    });
    EXPECT_FALSE(search.converged);
    EXPECT_FALSE(search.at_jump);
    EXPECT_EQ(search.angle_rad, 0.5);
    EXPECT_EQ(last_tried_rad, 0.5);
}

TEST(AngleSearch, FindsAFallingTorquesRootBehindTheStart) {
    const AngleSearch search =
        search_angle({2.0, -8.0}, [](double angle_rad) { return 8.0 * std::tanh(-1.0 - angle_rad); });
    EXPECT_TRUE(search.converged);
    EXPECT_NEAR(search.angle_rad, -1.0, 1e-10);
}

}  // namespace
}  // namespace capstan
