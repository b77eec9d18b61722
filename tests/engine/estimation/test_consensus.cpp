// The bit-parallel vote against sorting the votes segment by segment.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "capstan/estimation/consensus.h"

namespace capstan {
namespace {

int way_of(const DirectionBits& bits, int segment) {
    return static_cast<int>(bits.forward >> segment & 1) - static_cast<int>(bits.backward >> segment & 1);
}

// Any directions, also ones that no pattern has; `lean` makes a vote forward (2), backward (0) or even (1).
DirectionBits random_vote(int segments, int lean, std::mt19937_64& random) {
    DirectionBits vote{};
    for (int i = 0; i < segments; ++i) {
        const int way = std::clamp(
            static_cast<int>(random() % 3) - 1 + static_cast<int>(random() % 2) * (lean - 1), -1, 1);
        if (way > 0) vote.forward |= std::uint64_t{1} << i;
        if (way < 0) vote.backward |= std::uint64_t{1} << i;
    }
    return vote;
}

void expect_the_sorted_median(const std::vector<DirectionBits>& votes, int segments) {
    const DirectionConsensus consensus = median_direction(votes, segments);
    ASSERT_EQ(consensus.directions.forward & consensus.directions.backward, 0u);
    ASSERT_EQ(
        (consensus.directions.forward | consensus.directions.backward | consensus.undecided) >> segments, 0u);
    for (int i = 0; i < segments; ++i) {
        std::vector<int> ways;
        for (const DirectionBits& vote : votes) ways.push_back(way_of(vote, i));
        std::sort(ways.begin(), ways.end());
        const int twice_the_median = ways[(ways.size() - 1) / 2] + ways[ways.size() / 2];
        const bool undecided = consensus.undecided >> i & 1;
        ASSERT_EQ(undecided, twice_the_median % 2 != 0) << votes.size() << " votes, segment " << i;
        if (!undecided) {
            ASSERT_EQ(2 * way_of(consensus.directions, i), twice_the_median)
                << votes.size() << " votes, segment " << i;
        }
    }
}

TEST(MedianDirection, IsTheMiddleOfTheSortedVotes) {
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 5000; ++trial) {
        const int segments = 1 + static_cast<int>(random() % 63);
        const int lean = static_cast<int>(random() % 3);
        std::vector<DirectionBits> votes(1 + random() % 12);
        for (DirectionBits& vote : votes) vote = random_vote(segments, lean, random);
        expect_the_sorted_median(votes, segments);
    }
}

TEST(MedianDirection, CountsUpToSixtyFourVotes) {
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<DirectionBits> votes(60 + random() % 5);
        for (DirectionBits& vote : votes) vote = random_vote(63, static_cast<int>(random() % 3), random);
        expect_the_sorted_median(votes, 63);
    }
    const std::vector<DirectionBits> all_forward(64, DirectionBits{~std::uint64_t{0} >> 1, 0});
    EXPECT_EQ(median_direction(all_forward, 63).directions, all_forward.front());
}

TEST(MedianDirection, ATieBetweenRestAndMotionIsUndecidedAndOneBetweenTheWaysIsRest) {
    const DirectionBits forward{1, 0};
    const DirectionBits backward{0, 1};
    const DirectionBits rest{0, 0};
    EXPECT_EQ(median_direction(std::vector{forward, rest}, 1).undecided, 1u);
    EXPECT_EQ(median_direction(std::vector{backward, rest}, 1).undecided, 1u);
    EXPECT_EQ(median_direction(std::vector{forward, backward}, 1).undecided, 0u);
    EXPECT_EQ(median_direction(std::vector{forward, backward}, 1).directions, rest);
    EXPECT_EQ(median_direction(std::vector{forward, backward, forward, forward}, 1).directions, forward);
}

TEST(MedianDirection, DoesNotDependOnTheOrderOfTheVotes) {
    std::mt19937_64 random(3);
    std::vector<DirectionBits> votes(8);
    for (DirectionBits& vote : votes) vote = random_vote(20, 1, random);
    const DirectionConsensus before = median_direction(votes, 20);
    for (int trial = 0; trial < 50; ++trial) {
        std::shuffle(votes.begin(), votes.end(), random);
        const DirectionConsensus after = median_direction(votes, 20);
        EXPECT_EQ(after.directions, before.directions);
        EXPECT_EQ(after.undecided, before.undecided);
    }
}

TEST(MedianDirection, WithoutVotesIsRest) {
    const DirectionConsensus consensus = median_direction({}, 10);
    EXPECT_EQ(consensus.directions, (DirectionBits{0, 0}));
    EXPECT_EQ(consensus.undecided, 0u);
}

TEST(AgreeingNodes, AgreeOnTheSegmentsOnBothSides) {
    std::mt19937_64 random(4);
    for (int trial = 0; trial < 3000; ++trial) {
        const int segments = 1 + static_cast<int>(random() % 63);
        std::vector<DirectionBits> votes(2 + random() % 3);
        for (DirectionBits& vote : votes) vote = random_vote(segments, 2, random);
        const DirectionConsensus consensus = median_direction(votes, segments);
        const std::uint64_t agrees = agreeing_nodes(votes[0], consensus, segments);
        const auto segment_agrees = [&](int i) {
            return !(consensus.undecided >> i & 1) && way_of(votes[0], i) == way_of(consensus.directions, i);
        };
        for (int node = 0; node <= segments; ++node) {
            const bool expected =
                (node == 0 || segment_agrees(node - 1)) && (node == segments || segment_agrees(node));
            ASSERT_EQ(static_cast<bool>(agrees >> node & 1), expected)
                << "node " << node << " of " << segments;
        }
        if (segments < 63) {
            ASSERT_EQ(agrees >> (segments + 1), 0u);
        }
    }
}

TEST(MovingNodes, HaveASlidingSegmentBesideThem) {
    std::mt19937_64 random(5);
    for (int trial = 0; trial < 1000; ++trial) {
        const int segments = 1 + static_cast<int>(random() % 63);
        const DirectionBits vote = random_vote(segments, 1, random);
        const std::uint64_t moving = moving_nodes(vote);
        for (int node = 0; node <= segments; ++node) {
            const bool expected =
                (node > 0 && way_of(vote, node - 1) != 0) || (node < segments && way_of(vote, node) != 0);
            ASSERT_EQ(static_cast<bool>(moving >> node & 1), expected)
                << "node " << node << " of " << segments;
        }
    }
}

}  // namespace
}  // namespace capstan
