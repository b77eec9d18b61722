// Voting and leaving out, on three sensors of a cable of 3 segments with hand-made estimates.
#include <gtest/gtest.h>

#include "capstan/estimation/fusion_method.h"

namespace capstan {
namespace {

constexpr int nodes = 4;
constexpr std::uint64_t every_node = 0b1111;
const DirectionBits forward{0b111, 0};
const DirectionBits backward{0, 0b111};
const DirectionBits front_at_node_2{0b011, 0};  // the last segment rests, and node 3 with it
const DirectionBits rest{0, 0};

struct Estimates {
    std::vector<DirectionBits> directions = std::vector<DirectionBits>(nodes, forward);
    std::vector<std::uint8_t> verified = std::vector<std::uint8_t>(nodes, 1);
    std::vector<double> tension_N = {1, 2, 3, 4, 5, 6, 7, 8, 20, 30, 40, 50, 9, 9, 9, 9};  // sensors x nodes

    SensorEstimates view() const { return {nodes, tension_N, directions, verified}; }
};

std::vector<double> fused(const FusionMethod& method, const Estimates& estimates,
                          const std::vector<int>& sensors, const std::vector<double>& weight) {
    const SensorVote vote = take_vote(estimates.view(), sensors);
    FusionInput input;
    input.sensors = sensors;
    input.unknown = estimates.view();
    input.weight = weight;
    input.vote = &vote;
    std::vector<double> tension_N(nodes);
    method.fuse(input, tension_N);
    return tension_N;
}

TEST(SensorEstimates, LieOneAfterTheOther) {
    const Estimates estimates;
    for (int sensor = 0; sensor < nodes; ++sensor) {
        const double* profile_N = estimates.view().padded_profile_N(sensor);
        for (int i = 0; i < nodes; ++i) EXPECT_EQ(profile_N[i], estimates.tension_N[sensor * nodes + i]);
    }
}

TEST(SensorVote, IsUnanimousIfAllEstimatesAreEqual) {
    const SensorVote vote = take_vote(Estimates{}.view(), std::vector{0, 1, 3});
    EXPECT_TRUE(vote.unanimous);
    EXPECT_EQ(vote.used, 3);
}

TEST(SensorVote, TheOneAgainstTwoAgreesOnlyWhereBothSegmentsBesideTheNodeDo) {
    Estimates estimates;
    estimates.directions[3] = front_at_node_2;
    const SensorVote vote = take_vote(estimates.view(), std::vector{0, 1, 3});
    ASSERT_EQ(vote.used, 3);
    EXPECT_FALSE(vote.unanimous);
    EXPECT_EQ(vote.agrees[0] & every_node, every_node);
    EXPECT_EQ(vote.agrees[2] & every_node, 0b0011u);
}

TEST(SensorVote, LeavesOutASensorWhoseNodeRestsByMajority) {
    Estimates estimates;
    estimates.directions = {front_at_node_2, front_at_node_2, forward, forward};
    const SensorVote vote = take_vote(estimates.view(), std::vector{0, 1, 3});
    ASSERT_EQ(vote.used, 2);
    EXPECT_EQ(vote.sensor[0], 0);
    EXPECT_EQ(vote.sensor[1], 1);
}

TEST(SensorVote, KeepsAllWhenAllRest) {
    Estimates estimates;
    estimates.directions.assign(nodes, rest);
    EXPECT_EQ(take_vote(estimates.view(), std::vector{0, 1, 2}).used, 3);
}

TEST(SensorVote, AnUnverifiedEstimateCountsAsAgreeing) {
    Estimates estimates;
    estimates.directions[2] = backward;
    EXPECT_FALSE(take_vote(estimates.view(), std::vector{0, 1, 2}).unanimous);
    estimates.verified[2] = 0;
    EXPECT_TRUE(take_vote(estimates.view(), std::vector{0, 1, 2}).unanimous);
}

TEST(Fusion, FollowsItsDefinitionWhenOneDisagrees) {
    Estimates estimates;
    estimates.directions[2] = backward;
    const std::vector<int> sensors = {0, 1, 2};
    const std::vector<double> weight = {1.0, 2.0, 5.0, 1.0};
    const auto mean_N = fused(mean_method, estimates, sensors, weight);
    const auto mean_r_N = fused(mean_r_method, estimates, sensors, weight);
    const auto w_mean_N = fused(weighted_mean_method, estimates, sensors, weight);
    const auto w_mean_r_N = fused(weighted_mean_r_method, estimates, sensors, weight);
    for (int i = 0; i < nodes; ++i) {
        const double a = 1.0 + i;
        const double b = 5.0 + i;
        const double c = 20.0 + 10.0 * i;  // the one that disagrees
        EXPECT_DOUBLE_EQ(mean_N[i], (a + b + c) / 3.0);
        EXPECT_DOUBLE_EQ(mean_r_N[i], (a + b) / 2.0);
        EXPECT_DOUBLE_EQ(w_mean_N[i], (a + 2.0 * b + 5.0 * c) / 8.0);
        EXPECT_DOUBLE_EQ(w_mean_r_N[i], (a + 2.0 * b) / 8.0);
    }
}

// Even a single one: what rests under the true direction carries no information.
TEST(Fusion, WithAKnownDirectionOnlySensorsThatMoveCount) {
    Estimates estimates;
    FusionInput input;
    const std::vector<int> sensors = {0, 1, 2};
    input.sensors = sensors;
    std::vector<double> tension_N(nodes);
    estimates.verified = {0, 1, 0, 1};
    input.known = estimates.view();
    mean_known_direction.fuse(input, tension_N);
    EXPECT_EQ(tension_N, (std::vector<double>{5, 6, 7, 8}));
    estimates.verified = {0, 0, 0, 1};
    input.known = estimates.view();
    mean_known_direction.fuse(input, tension_N);
    for (int i = 0; i < nodes; ++i)
        EXPECT_DOUBLE_EQ(tension_N[i], (1.0 + i + 5.0 + i + 20.0 + 10.0 * i) / 3.0);
}

// The excluded weight is not shared out (the paper), so that tensions come out too small, whoever is right.
TEST(Fusion, WMeanRIsBelowWMeanWhereASensorIsExcluded) {
    Estimates estimates;
    const std::vector<int> sensors = {0, 1, 2};
    const std::vector<double> weight = {1.0, 2.0, 0.5, 1.0};
    for (const int dissenter : sensors) {
        estimates.directions.assign(nodes, forward);
        estimates.directions[dissenter] = backward;
        const auto w_mean_N = fused(weighted_mean_method, estimates, sensors, weight);
        const auto w_mean_r_N = fused(weighted_mean_r_method, estimates, sensors, weight);
        for (int i = 0; i < nodes; ++i) EXPECT_LT(w_mean_r_N[i], w_mean_N[i]);
    }
}

TEST(Fusion, LeavingOutChangesNothingIfAllSensorsAgree) {
    const std::vector<int> sensors = {0, 1, 2};
    const std::vector<double> weight = {1.0, 2.0, 0.5, 1.0};
    const Estimates estimates;
    EXPECT_EQ(fused(mean_r_method, estimates, sensors, weight),
              fused(mean_method, estimates, sensors, weight));
    EXPECT_EQ(fused(weighted_mean_r_method, estimates, sensors, weight),
              fused(weighted_mean_method, estimates, sensors, weight));
}

// Two sensors, opposite directions: the median is rest, and nobody says rest.
TEST(Fusion, FallsBackToTheMeanWhereNoSensorAgrees) {
    Estimates estimates;
    estimates.directions[1] = backward;
    const std::vector<int> sensors = {0, 1};
    EXPECT_EQ(fused(mean_r_method, estimates, sensors, {}), fused(mean_method, estimates, sensors, {}));
    const std::vector<double> weight = {1.0, 2.0, 0.5, 1.0};
    EXPECT_EQ(fused(weighted_mean_r_method, estimates, sensors, weight),
              fused(weighted_mean_method, estimates, sensors, weight));
}

}  // namespace
}  // namespace capstan
