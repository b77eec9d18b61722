#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "capstan/estimation/information_bound.h"
#include "paper_experiment.h"

namespace capstan {
namespace {

using test::Instant;
using test::paper_instant;

using Branches = std::vector<std::optional<SensorBranch>>;  // nodes

Branches known_branches(const Instant& instant) {
    Branches branches;
    for (int node = 0; node < instant.nodes(); ++node) {
        branches.push_back(known_direction_branch(instant.problem(), instant.truth.last_motion, node));
    }
    return branches;
}

double bound_N(const Instant& instant, const std::vector<int>& sensors, const NoiseLevel& noise) {
    return known_direction_bound_N(known_branches(instant), instant.truth.tension_N, sensors, noise);
}

double error_N(const Instant& instant, const SensorBranch& branch, double reading_N) {
    std::vector<double> tension_N;
    for (int i = 0; i < instant.nodes(); ++i) tension_N.push_back(branch.tension_N(i, reading_N));
    return test::mean_abs_error_N(tension_N, instant.truth.tension_N);
}

// A reading scales the complete profile, so that a relative error e of the reading is one of the mean
// tension.
TEST(KnownDirection, RelativeErrorIsThatOfTheReadingAtAnySensorNode) {
    for (const int sample : test::mass_samples) {
        const Instant instant = paper_instant(sample);
        const Branches branches = known_branches(instant);
        for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
            ASSERT_TRUE(branches[sensor].has_value());
            for (const double e : {-0.3, 0.0, 0.01, 0.2}) {
                const double reading_N = instant.truth.tension_N[sensor] * (1.0 + e);
                EXPECT_NEAR(error_N(instant, *branches[sensor], reading_N),
                            std::abs(e) * instant.mean_tension_N(), 1e-12);
            }
        }
    }
}

// E|e| = sqrt(2 / pi) for a standard normal, with variance 1 - 2 / pi; 4 standard errors.
TEST(KnownDirection, MeanErrorAtTenPercentNoiseIsEightPercentOfTheMeanTension) {
    constexpr int repetitions = 2000;
    const double closed_form = 0.1 * std::sqrt(2.0 / std::numbers::pi);
    const double standard_error = 0.1 * std::sqrt((1.0 - 2.0 / std::numbers::pi) / repetitions);
    for (const int sample : test::mass_samples) {
        const Instant instant = paper_instant(sample);
        const Branches branches = known_branches(instant);
        std::vector<double> mean_N(instant.nodes(), 0.0);
        for (int r = 0; r < repetitions; ++r) {
            const auto reading_N = test::noisy_readings(instant, sample, r);
            for (int i = 0; i < instant.nodes(); ++i) {
                mean_N[i] += error_N(instant, *branches[i], reading_N[i]) / repetitions;
            }
        }
        for (const double sensor_mean_N : mean_N) {
            EXPECT_NEAR(sensor_mean_N / instant.mean_tension_N(), closed_form, 4.0 * standard_error);
        }
    }
}

TEST(KnownDirection, ASensorAtRestCarriesNoInformation) {
    for (const int sample : test::partial_samples) {
        const Instant instant = paper_instant(sample);
        ASSERT_EQ(instant.truth.last_motion.proximal_moving_nodes, 8) << "the paper's last-moving node";
        const Branches branches = known_branches(instant);
        for (int node = 0; node < instant.nodes(); ++node) EXPECT_EQ(branches[node].has_value(), node < 8);
    }
}

TEST(KnownDirection, ReadingsOfASlackCableCarryNoInformation) {
    const Instant instant = paper_instant(112);
    MotionPattern slack;
    slack.kind = MotionKind::slack;
    for (int node = 0; node < instant.nodes(); ++node)
        EXPECT_FALSE(known_direction_branch(instant.problem(), slack, node).has_value());
}

// The point without velocity lies in the fourth segment; the segment goes with the longer part of it.
TEST(KnownDirection, ChangesAtTheZeroVelocityPointWhereTheEndsMoveApart) {
    const Instant instant = paper_instant(112);
    for (const double fraction : {0.3, 0.7}) {
        const MotionPattern truth{
            MotionKind::opposed, Direction::backward, Direction::forward, 4, 7, fraction};
        const std::uint64_t with_proximal_end = fraction > 0.5 ? 0b1111 : 0b111;
        for (int node = 0; node < instant.nodes(); ++node) {
            const auto branch = known_direction_branch(instant.problem(), truth, node);
            ASSERT_TRUE(branch.has_value()) << node;
            EXPECT_EQ(branch->directions.backward, with_proximal_end);
            EXPECT_EQ(branch->directions.forward, 0b1111111111 & ~with_proximal_end);
            EXPECT_NEAR(branch->tension_N(node, 7.0), 7.0, 1e-12);
        }
    }
}

// Information of one reading about the logarithm of the scale: 1 / 0.1^2 from its mean and 2 from its
// deviation, so 0.1 sqrt(2 / pi) / sqrt(1.02) = 0.0790 of the mean tension.
TEST(KnownDirectionBound, IsItsClosedFormInMassMotion) {
    const double factor = 0.1 * std::sqrt(2.0 / std::numbers::pi) / std::sqrt(1.02);
    EXPECT_NEAR(factor, 0.0790, 0.00005);
    for (const int sample : test::mass_samples) {
        const Instant instant = paper_instant(sample);
        for (int count = 1; count <= instant.nodes(); ++count) {
            std::vector<int> sensors(count);
            std::iota(sensors.begin(), sensors.end(), instant.nodes() - count);
            EXPECT_NEAR(bound_N(instant, sensors, test::ten_percent),
                        factor * instant.mean_tension_N() / std::sqrt(count), 1e-10);
        }
    }
}

// With additive noise the reading's mean alone informs: sigma over the tension, of the mean tension.
TEST(KnownDirectionBound, IsItsClosedFormForAdditiveNoise) {
    const Instant instant = paper_instant(112);
    for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
        EXPECT_NEAR(bound_N(instant, {sensor}, {0.0, 0.5, 0.0}),
                    std::sqrt(2.0 / std::numbers::pi) * 0.5 / instant.truth.tension_N[sensor] *
                        instant.mean_tension_N(),
                    1e-10);
    }
}

TEST(KnownDirectionBound, AddingASensorNeverRaisesTheBound) {
    std::mt19937_64 random(1);
    const NoiseLevel noises[] = {test::ten_percent, {0.0, 0.5, 0.0}, {0.05, 0.2, 0.3}};
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        for (int trial = 0; trial < 100; ++trial) {
            std::vector<int> order(instant.nodes());
            std::iota(order.begin(), order.end(), 0);
            std::shuffle(order.begin(), order.end(), random);
            double before_N = std::numeric_limits<double>::infinity();
            std::vector<int> sensors;
            for (const int sensor : order) {
                sensors.push_back(sensor);
                const double now_N = bound_N(instant, sensors, noises[trial % 3]);
                ASSERT_LE(now_N, before_N * (1.0 + 1e-14));
                before_N = now_N;
            }
        }
    }
}

TEST(KnownDirectionBound, IsZeroWithoutNoise) {
    EXPECT_EQ(bound_N(paper_instant(112), {0, 10}, NoiseLevel{}), 0.0);
}

TEST(KnownDirectionBound, IsInfiniteWhenNoSensorMoves) {
    const Instant instant = paper_instant(6);
    EXPECT_TRUE(std::isinf(bound_N(instant, {8, 9, 10}, test::ten_percent)));
    EXPECT_TRUE(std::isfinite(bound_N(instant, {7, 8, 9, 10}, test::ten_percent)));
    EXPECT_EQ(bound_N(instant, {7, 8, 9, 10}, test::ten_percent), bound_N(instant, {7}, test::ten_percent));
}

}  // namespace
}  // namespace capstan
