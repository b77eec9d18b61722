// The search for a pulley's angle, on torques nastier than two cables'.
#include <gtest/gtest.h>

#include <algorithm>
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

// The first two trials give the slope, the third lies just beyond the root, and there the secant is exact.
TEST(AngleSearch, FindsTheRootOfAStraightLineInFourTrialsWithoutGoingFarBeyondIt) {
    for (const double start_rad : {-3.0, 0.0, 0.7}) {
        for (const double way : {1.0, -1.0}) {
            for (const double slope_Nm_per_rad : {0.5, -0.5}) {
                const double root_rad = start_rad + 0.2 * way;
                double farthest_rad = 0.0;
                const AngleSearch search =
                    search_angle({start_rad, 20.0 * slope_Nm_per_rad}, [&](double angle_rad) {
                        farthest_rad = std::max(farthest_rad, std::abs(angle_rad - start_rad));
                        return slope_Nm_per_rad * (angle_rad - root_rad);
                    });
                EXPECT_TRUE(search.converged);
                EXPECT_FALSE(search.at_jump);
                EXPECT_NEAR(search.angle_rad, root_rad, 1e-9);
                EXPECT_LE(search.iterations, 4);
                EXPECT_LT(farthest_rad, 0.25);
            }
        }
    }
}

// A torque that is steep near the start and gentle beyond: two trials beyond the kink give the slope to the
// root.
TEST(AngleSearch, FindsTheRootBehindAKinkInFiveTrials) {
    const AngleSearch search = search_angle(
        {0.0, 20.0}, [](double angle_rad) { return std::min(20.0 * angle_rad - 2.0, angle_rad - 1.05); });
    EXPECT_TRUE(search.converged);
    EXPECT_NEAR(search.angle_rad, 1.05, 1e-9);
    EXPECT_LE(search.iterations, 5);
}

TEST(AngleSearch, IsDoneAtTheErrorAtWhichItMayStop) {
    for (const double error_Nm : {torque_tolerance_Nm, -torque_tolerance_Nm}) {
        const AngleSearch search = search_angle({0.5, 10.0}, [&](double) { return error_Nm; });
        EXPECT_TRUE(search.converged);
        EXPECT_EQ(search.iterations, 1);
        EXPECT_EQ(search.angle_rad, 0.5);
    }
}

// The search is asked for a smaller residual than the tolerance, and both sides of the jump are between them.
TEST(AngleSearch, DoesNotReportAJumpWithinTheTolerance) {
    const auto jumps = [](double angle_rad) { return (angle_rad < 0.3 ? -0.2 : 0.5) * torque_tolerance_Nm; };
    const AngleSearch search = search_angle({0.0, 1e-9, 0.01 * torque_tolerance_Nm}, jumps);
    EXPECT_TRUE(search.converged);
    EXPECT_FALSE(search.at_jump);
    EXPECT_NEAR(search.angle_rad, 0.3, 1e-12);
}

// The large error puts every secant at the far side of the bracket, so that each trial only halves it. From 1
// to 1e-300 takes about a thousand halvings.
TEST(AngleSearch, DoesNotReportAJumpWhenItRunsOutOfTrials) {
    const AngleSearch search =
        search_angle({0.0, 1e300}, [](double angle_rad) { return angle_rad < 1e-300 ? -1e300 : 1.0; });
    EXPECT_FALSE(search.converged);
    EXPECT_FALSE(search.at_jump);
    EXPECT_EQ(search.torque_residual_Nm, 1.0) << "the side that is less wrong";
}

TEST(AngleSearch, FindsAFallingTorquesRootBehindTheStart) {
    const AngleSearch search =
        search_angle({2.0, -8.0}, [](double angle_rad) { return 8.0 * std::tanh(-1.0 - angle_rad); });
    EXPECT_TRUE(search.converged);
    EXPECT_NEAR(search.angle_rad, -1.0, 1e-10);
}

}  // namespace
}  // namespace capstan
