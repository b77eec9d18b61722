#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "capstan/sensing/random_stream.h"

namespace capstan {
namespace {

std::vector<RandomAddress> some_addresses() {
    std::vector<RandomAddress> addresses;
    for (std::uint32_t scenario = 0; scenario < 4; ++scenario) {
        for (std::uint32_t repetition = 0; repetition < 50; ++repetition) {
            for (std::uint32_t node = 0; node < 11; ++node) {
                addresses.push_back({7, RandomPurpose::reading_noise, scenario, repetition, node});
            }
        }
    }
    return addresses;
}

TEST(RandomStream, TheSameAddressGivesTheSameNumbersInAnyOrder) {
    const std::vector<RandomAddress> addresses = some_addresses();
    std::vector<std::array<double, 2>> in_order;
    for (const RandomAddress& address : addresses) in_order.push_back(standard_normals(address));

    std::vector<std::size_t> places(addresses.size());
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = k;
    std::shuffle(places.begin(), places.end(), std::mt19937_64(1));
    for (const std::size_t place : places) EXPECT_EQ(standard_normals(addresses[place]), in_order[place]);
}

TEST(RandomStream, EveryPartOfTheAddressMatters) {
    const RandomAddress address{7, RandomPurpose::reading_noise, 2, 3, 4};
    std::vector<RandomAddress> others(7, address);
    others[0].seed = 8;
    others[1].seed = address.seed + (std::uint64_t{1} << 32);  // the upper half of the seed counts too
    others[2].purpose = RandomPurpose::sensor_bias;
    others[3].scenario = 3;
    others[4].repetition = 2;
    others[5].node = 5;
    std::swap(others[6].scenario, others[6].repetition);
    for (std::size_t k = 0; k < others.size(); ++k) {
        EXPECT_NE(standard_normals(others[k])[0], standard_normals(address)[0]) << "part " << k;
        EXPECT_NE(standard_normals(others[k])[1], standard_normals(address)[1]) << "part " << k;
    }
}

TEST(RandomStream, NoTwoAddressesShareANumber) {
    std::set<double> seen;
    for (const RandomAddress& address : some_addresses()) {
        for (const double number : standard_normals(address)) EXPECT_TRUE(seen.insert(number).second);
    }
}

// Sums over many draws, each with the expectation and the variance it has for a standard normal.
struct Moments {
    static constexpr int draws = 100'000;
    double mean = 0.0;
    double square = 0.0;
    double fourth = 0.0;
    double with_its_pair = 0.0;
    double with_next_node = 0.0;
    double with_next_repetition = 0.0;
};

Moments moments_of_the_stream(std::uint64_t seed) {
    const auto draw = [&](std::uint32_t repetition, std::uint32_t node) {
        return standard_normals({seed, RandomPurpose::reading_noise, 0, repetition, node});
    };
    Moments sum;
    for (std::uint32_t k = 0; k < Moments::draws; ++k) {
        const std::uint32_t repetition = k / 10;
        const std::uint32_t node = k % 10;
        const auto [x, pair] = draw(repetition, node);
        sum.mean += x / Moments::draws;
        sum.square += x * x / Moments::draws;
        sum.fourth += x * x * x * x / Moments::draws;
        sum.with_its_pair += x * pair / Moments::draws;
        sum.with_next_node += x * draw(repetition, node + 1)[0] / Moments::draws;
        sum.with_next_repetition += x * draw(repetition + 1, node)[0] / Moments::draws;
    }
    return sum;
}

// Bounds of 4 standard errors: with 18 comparisons a right stream fails one seed in a thousand, and the seeds
// are fixed. Variances of one term: x 1, x^2 2, x^4 96, a product of independent ones 1.
TEST(RandomStream, HasTheMomentsOfIndependentStandardNormals) {
    const double sigma = 1.0 / std::sqrt(static_cast<double>(Moments::draws));
    for (const std::uint64_t seed : {1u, 2u, 20250101u}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Moments moments = moments_of_the_stream(seed);
        EXPECT_NEAR(moments.mean, 0.0, 4.0 * sigma);
        EXPECT_NEAR(moments.square, 1.0, 4.0 * std::sqrt(2.0) * sigma);
        EXPECT_NEAR(moments.fourth, 3.0, 4.0 * std::sqrt(96.0) * sigma);
        EXPECT_NEAR(moments.with_its_pair, 0.0, 4.0 * sigma);
        EXPECT_NEAR(moments.with_next_node, 0.0, 4.0 * sigma);
        EXPECT_NEAR(moments.with_next_repetition, 0.0, 4.0 * sigma);
    }
}

// The tails, where Box-Muller on coarse uniforms would end early: P(|x| > 4) = 6.33e-5, of 400,000 numbers
// 25.3 with a standard deviation of 5.
TEST(RandomStream, ReachesIntoTheTails) {
    int beyond_four = 0;
    for (std::uint32_t k = 0; k < 200'000; ++k) {
        for (const double x : standard_normals({3, RandomPurpose::sensor_bias, 0, k, 0})) {
            ASSERT_TRUE(std::isfinite(x));
            beyond_four += std::abs(x) > 4.0;
        }
    }
    EXPECT_NEAR(beyond_four, 25.3, 20.0);
}

}  // namespace
}  // namespace capstan
