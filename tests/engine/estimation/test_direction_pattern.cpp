#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "capstan/estimation/direction_pattern.h"
#include "capstan/estimation/single_sensor.h"
#include "paper_experiment.h"

namespace capstan {
namespace {

// The paper's Appendix I, counted there as n_p* = 2 N^2 + 1.
TEST(AdmissiblePatterns, AreTwiceTheSquarePlusOneAndAllDifferent) {
    for (int segments = 1; segments <= 12; ++segments) {
        const auto patterns = admissible_patterns(segments);
        EXPECT_EQ(static_cast<int>(patterns.size()), 2 * segments * segments + 1) << segments << " segments";
        std::set<std::pair<std::uint64_t, std::uint64_t>> different;
        for (const DirectionPattern& pattern : patterns) {
            const DirectionBits bits = direction_bits(pattern, segments);
            different.insert({bits.forward, bits.backward});
        }
        EXPECT_EQ(different.size(), patterns.size()) << segments << " segments";
    }
}

TEST(AdmissiblePatterns, RestOnlyBetweenTheTwoSides) {
    for (const DirectionPattern& pattern : admissible_patterns(9)) {
        int changes = 0;
        for (int i = 1; i < 9; ++i) changes += pattern.segment(i, 9) != pattern.segment(i - 1, 9);
        EXPECT_LE(changes, 2);
    }
}

TEST(AdmissiblePatterns, SlideInTheirLeadingAndTrailingSegmentsOnly) {
    for (const DirectionPattern& pattern : admissible_patterns(9)) {
        const DirectionBits bits = direction_bits(pattern, 9);
        EXPECT_EQ(std::popcount(bits.forward | bits.backward), pattern.leading + pattern.trailing);
    }
}

TEST(DirectionBits, HoldTheDirectionOfEverySegment) {
    for (const int segments : {1, 2, 7, 63}) {
        for (const DirectionPattern& pattern : admissible_patterns(segments)) {
            const DirectionBits bits = direction_bits(pattern, segments);
            for (int i = 0; i < segments; ++i) {
                const int way =
                    static_cast<int>(bits.forward >> i & 1) - static_cast<int>(bits.backward >> i & 1);
                ASSERT_EQ(way, sign(pattern.segment(i, segments)));
            }
            ASSERT_EQ((bits.forward | bits.backward) >> segments, 0u) << "nothing beyond the cable";
        }
    }
}

TEST(HammingDistance, CountsTheSegmentsThatDiffer) {
    const int segments = 5;
    const auto patterns = admissible_patterns(segments);
    for (const DirectionPattern& a : patterns) {
        for (const DirectionPattern& b : patterns) {
            int differing = 0;
            for (int i = 0; i < segments; ++i) differing += a.segment(i, segments) != b.segment(i, segments);
            ASSERT_EQ(hamming_distance(direction_bits(a, segments), direction_bits(b, segments)), differing);
        }
    }
}

TEST(HammingDistance, IsTheOrderInWhichAnEstimatorTriesPatterns) {
    for (const int sample : {112, 142, 6, 104}) {
        const test::Instant instant = test::paper_instant(sample);
        const SingleSensorEstimator estimator(instant.problem(), DistalSide::admitted);
        const DirectionBits before = direction_bits(instant.previous.last_motion, 10);
        for (int sensor = 0; sensor < 11; ++sensor) {
            const auto branches = estimator.branches(sensor);
            for (std::size_t k = 1; k + 1 < branches.size(); ++k) {
                EXPECT_LE(hamming_distance(branches[k - 1].directions, before),
                          hamming_distance(branches[k].directions, before));
            }
        }
    }
}

}  // namespace
}  // namespace capstan
