#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "capstan/estimation/stratified_scores.h"

namespace capstan {
namespace {

TEST(NormalScores, RiseAreSymmetricAndHaveVarianceOne) {
    for (const int count : {2, 3, 5, 8, 32, 1024}) {
        const std::vector<double> scores = normal_scores(count);
        ASSERT_EQ(scores.size(), static_cast<std::size_t>(count));
        double squares = 0.0;
        for (std::size_t k = 0; k < scores.size(); ++k) {
            EXPECT_EQ(scores[k], -scores[scores.size() - 1 - k]) << count;
            if (k > 0) {
                EXPECT_GT(scores[k], scores[k - 1]) << count;
            }
            squares += scores[k] * scores[k];
        }
        EXPECT_NEAR(squares / count, 1.0, 1e-12) << count;
    }
}

// Phi(2.575829) = 0.995, Phi(1.253565) = 0.895, Phi(0.510073) = 0.695; all by one factor, for the variance.
TEST(NormalScores, AreTheQuantilesOfTheMiddlesOfEqualFractionsUpToAFactor) {
    const std::vector<double> scores = normal_scores(100);
    EXPECT_NEAR(scores[99] / scores[89], 2.575829 / 1.253565, 1e-5);
    EXPECT_NEAR(scores[89] / scores[69], 1.253565 / 0.510073, 1e-5);
    EXPECT_NEAR(scores[99], 2.575829, 0.03);
}

TEST(StratifiedScores, UseEveryScoreOnceInEveryDraw) {
    const std::vector<double> scores = normal_scores(16);
    for (const double start : {0.01, 0.5, 0.99}) {
        for (const double stride : {0.01, 0.5, 0.99}) {
            const StratifiedScores dealt(scores, {start, stride});
            std::set<double> seen;
            for (std::size_t member = 0; member < scores.size(); ++member) seen.insert(dealt[member]);
            EXPECT_EQ(seen.size(), scores.size()) << start << " " << stride;
        }
    }
}

}  // namespace
}  // namespace capstan
