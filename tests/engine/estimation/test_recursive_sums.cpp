// The sums over member_count, and the gains that a reading gives, once more one number after the other in
// long double.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "capstan/estimation/recursive_sums.h"

namespace capstan {
namespace {

// Around the widths of vectors, and less than any of them.
constexpr int node_counts[] = {1, 2, 3, 4, 5, 7, 8, 9, 17, 31, 33};
constexpr int member_count = 16;

struct Members {
    std::vector<std::vector<double>> rows;  // member_count x nodes
    std::vector<double*> places;            // member_count
};

Members random_members(int nodes, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(10.0, 2.0);
    Members all;
    all.rows.assign(member_count, std::vector<double>(static_cast<std::size_t>(nodes)));
    for (auto& row : all.rows) {
        for (double& value : row) value = normal(random);
        all.places.push_back(row.data());
    }
    return all;
}

TEST(RecursiveSums, AreThoseOfAScalarReferenceInLongDouble) {
    for (const int nodes : node_counts) {
        const Members all = random_members(nodes, 1);
        std::vector<double> weight;
        for (int j = 0; j < member_count; ++j) weight.push_back(0.3 * j - 1.0);
        const auto count = static_cast<std::size_t>(nodes);
        std::vector<double> mean_N(count), deviation_N(count), sum(count);
        member_moments(all.places, mean_N, deviation_N);
        weighted_member_sums(all.places, weight, sum);
        for (std::size_t node = 0; node < count; ++node) {
            long double expected_mean = 0.0L, expected_sum = 0.0L, squares = 0.0L;
            for (int j = 0; j < member_count; ++j) {
                expected_mean += all.rows[j][node] / static_cast<long double>(member_count);
                expected_sum += static_cast<long double>(weight[j]) * all.rows[j][node];
            }
            for (int j = 0; j < member_count; ++j) {
                const long double off = all.rows[j][node] - expected_mean;
                squares += off * off;
            }
            EXPECT_NEAR(mean_N[node], static_cast<double>(expected_mean), 1e-13) << nodes << " nodes";
            EXPECT_NEAR(sum[node], static_cast<double>(expected_sum), 1e-12) << nodes << " nodes";
            EXPECT_NEAR(deviation_N[node], static_cast<double>(std::sqrt(squares / (member_count - 1))),
                        1e-13);
        }
    }
}

// E37: the gain is the covariance over the total variance, less by the part of its square that chance makes
// up; the deviation after it is that of values pulled by the fraction of the gain.
TEST(RecursiveSums, GainsAreCovariancesBeyondChance) {
    int pulled = 0;
    int left_alone = 0;
    for (const int nodes : node_counts) {
        std::mt19937_64 random(2);
        std::uniform_real_distribution<double> part(-1.0, 1.0);
        const GainTerms terms{16.0, 2.0, 2.6, 0.7, 4.0};
        std::vector<double> deviation_N, sums;
        for (int node = 0; node < nodes; ++node) {
            deviation_N.push_back(1.0 + 0.1 * node);
            sums.push_back(part(random) * std::sqrt(terms.variance) * deviation_N.back() * 15.0);
        }
        std::vector<double> gain = sums;
        std::vector<double> after_N = deviation_N;
        gains_of_sums(terms, gain, after_N);
        for (std::size_t node = 0; node < gain.size(); ++node) {
            const long double covariance = sums[node] / 15.0L;
            const long double squared = covariance * covariance;
            const long double node_variance = static_cast<long double>(deviation_N[node]) * deviation_N[node];
            const long double chance = 4.0L * (2.0L * node_variance - squared) / 14.0L;
            const long double trust = std::clamp(1.0L - chance / squared, 0.0L, 1.0L);
            const long double expected = trust * covariance / 2.6L;
            const long double pull = 0.7L * expected;
            EXPECT_NEAR(gain[node], static_cast<double>(expected), 1e-13);
            const long double left = node_variance - 2.0L * pull * covariance + pull * pull * 2.0L;
            EXPECT_NEAR(after_N[node], static_cast<double>(std::sqrt(left)), 1e-12);
            ++(trust > 0.0L ? pulled : left_alone);
        }
    }
    EXPECT_GT(pulled, 20);
    EXPECT_GT(left_alone, 20);
}

TEST(RecursiveSums, PullsMoveEveryNodeOfEveryMember) {
    for (const int nodes : node_counts) {
        Members all = random_members(nodes, 3);
        const Members before = random_members(nodes, 3);
        std::vector<double> gain, pull;
        for (int node = 0; node < nodes; ++node) gain.push_back(0.1 * node - 0.2);
        for (int j = 0; j < member_count; ++j) pull.push_back(0.5 * j - 3.0);
        add_pulls(gain, pull, all.places);
        for (int j = 0; j < member_count; ++j) {
            for (int node = 0; node < nodes; ++node)
                EXPECT_DOUBLE_EQ(all.rows[j][node], before.rows[j][node] + gain[node] * pull[j]);
        }
    }
}

}  // namespace
}  // namespace capstan
