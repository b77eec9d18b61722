#include <gtest/gtest.h>

#include <cmath>

#include "capstan/sensing/noise.h"

namespace capstan {
namespace {

const std::vector<double> tension_N = {4.0, 10.0, 0.0, 25.0};  // nodes
constexpr int nodes = 4;

std::vector<double> readings(const NoiseLevel& noise, const ReadingDraws& draws) {
    std::vector<double> reading_N(tension_N.size());
    read_tensions(noise, draws, tension_N, reading_N);
    return reading_N;
}

TEST(Noise, WithoutNoiseTheReadingIsTheTension) {
    EXPECT_EQ(readings({}, draw_readings({1, 0, 0}, nodes)), tension_N);
}

TEST(Noise, EachPartFollowsItsDefinition) {
    const ReadingDraws draws{{1.0, -2.0, 3.0, 0.5}, {0.25, 1.0, -1.0, 2.0}, {-1.0, 0.5, 2.0, 0.0}};
    const auto multiplicative = readings({0.1, 0.0, 0.0}, draws);
    const auto additive = readings({0.0, 0.2, 0.0}, draws);
    const auto bias = readings({0.0, 0.0, 0.3}, draws);
    const auto together = readings({0.1, 0.2, 0.3}, draws);
    for (int i = 0; i < nodes; ++i) {
        EXPECT_DOUBLE_EQ(multiplicative[i], tension_N[i] * (1.0 + 0.1 * draws.multiplicative[i]));
        EXPECT_DOUBLE_EQ(additive[i], tension_N[i] + 0.2 * draws.additive[i]);
        EXPECT_DOUBLE_EQ(bias[i], tension_N[i] + 0.3 * draws.bias[i]);
        EXPECT_NEAR(together[i] - tension_N[i],
                    multiplicative[i] + additive[i] + bias[i] - 3.0 * tension_N[i], 1e-14 * 25.0);
    }
}

TEST(Noise, ASensorKeepsItsBiasFromScenarioToScenario) {
    for (std::uint32_t repetition = 0; repetition < 20; ++repetition) {
        const ReadingDraws here = draw_readings({5, 0, repetition}, nodes);
        const ReadingDraws there = draw_readings({5, 3, repetition}, nodes);
        EXPECT_EQ(here.bias, there.bias);
        EXPECT_NE(here.multiplicative, there.multiplicative);
        EXPECT_NE(here.additive, there.additive);
    }
    EXPECT_NE(draw_readings({5, 0, 0}, nodes).bias, draw_readings({5, 0, 1}, nodes).bias);
}

TEST(Noise, AnotherNodeDoesNotChangeTheDrawsOfTheOthers) {
    const ReadingDraws few = draw_readings({5, 1, 2}, 3);
    const ReadingDraws many = draw_readings({5, 1, 2}, 12);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(few.multiplicative[i], many.multiplicative[i]);
        EXPECT_EQ(few.additive[i], many.additive[i]);
        EXPECT_EQ(few.bias[i], many.bias[i]);
    }
}

TEST(Noise, DeviationIsTheRootOfTheSquares) {
    EXPECT_DOUBLE_EQ(reading_deviation_N({0.1, 0.0, 0.0}, 10.0), 1.0);
    EXPECT_DOUBLE_EQ(reading_deviation_N({0.3, 4.0, 0.0}, 10.0), 5.0);
    EXPECT_DOUBLE_EQ(reading_deviation_N({0.0, 4.0, 3.0}, 10.0), 5.0);
}

// The standard error of a sample deviation over R draws is sigma / sqrt(2 R).
TEST(Noise, DeviationIsThatOfManyReadings) {
    const NoiseLevel noise{0.1, 0.4, 0.7};
    constexpr int repetitions = 20'000;
    std::vector<double> sum(nodes, 0.0);
    std::vector<double> squares(nodes, 0.0);
    for (std::uint32_t r = 0; r < repetitions; ++r) {
        const auto reading_N = readings(noise, draw_readings({11, 0, r}, nodes));
        for (int i = 0; i < nodes; ++i) {
            sum[i] += reading_N[i] - tension_N[i];
            squares[i] += std::pow(reading_N[i] - tension_N[i], 2);
        }
    }
    for (int i = 0; i < nodes; ++i) {
        const double deviation_N = reading_deviation_N(noise, tension_N[i]);
        EXPECT_NEAR(std::sqrt(squares[i] / repetitions), deviation_N,
                    4.0 * deviation_N / std::sqrt(2.0 * repetitions));
        EXPECT_NEAR(sum[i] / repetitions, 0.0, 4.0 * deviation_N / std::sqrt(double{repetitions}));
    }
}

TEST(Noise, AConverterRoundsToItsStepsAndASensorReadsNoMoreThanItsRange) {
    const NoiseLevel noise{.multiplicative_ratio = 0.1, .quantisation_N = 0.25, .range_N = 12.0};
    for (std::uint32_t repetition = 0; repetition < 200; ++repetition) {
        for (const double reading_N : readings(noise, draw_readings({3, 0, repetition}, nodes))) {
            EXPECT_EQ(reading_N / 0.25, std::round(reading_N / 0.25));
            EXPECT_LE(reading_N, 12.0);
        }
    }
}

// A reading with much noise to a step: the rounding adds step^2 / 12 to the variance. 40000 readings know a
// deviation to 0.35%; without the term it would be 2% too small.
TEST(Noise, RoundingAddsATwelfthOfTheStepSquaredToTheVariance) {
    const NoiseLevel noise{.additive_N = 0.3, .quantisation_N = 0.2};
    double squares_N2 = 0.0;
    constexpr int repetitions = 10000;
    for (std::uint32_t repetition = 0; repetition < repetitions; ++repetition) {
        const auto read_N = readings(noise, draw_readings({4, 0, repetition}, nodes));
        for (int i = 0; i < nodes; ++i) squares_N2 += std::pow(read_N[i] - tension_N[i], 2);
    }
    const double deviation_N = std::sqrt(squares_N2 / (repetitions * nodes));
    EXPECT_NEAR(deviation_N, reading_deviation_N(noise, 10.0), 0.0105 * deviation_N);
}

}  // namespace
}  // namespace capstan
