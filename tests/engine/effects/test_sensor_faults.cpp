// Each fault of a sensor by its closed form: what it makes of a constant, a step, a ramp and a slow cycle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/effects/sensor_faults.h"

namespace capstan {
namespace {

constexpr double time_step_s = 0.01;

std::vector<double> ramp(int samples) {
    std::vector<double> signal;
    for (int k = 0; k < samples; ++k) signal.push_back(2.0 * k);
    return signal;
}

TEST(SensorFaults, NoneChangesNoBit) {
    const std::vector<double> signal{0.1, 0.7, 0.3};
    EXPECT_EQ(sensed(signal, {}, time_step_s), signal);
}

TEST(SensorFaults, ASingleSampleStaysUnchanged) {
    SensorFaults all{0.5, 0.1, 0.03, 1.1, 0.2, 0.3, 9.0, 0.25};
    EXPECT_EQ(sensed({4.0}, all, time_step_s), std::vector<double>{4.0});
    EXPECT_TRUE(sensed({}, all, time_step_s).empty());
}

TEST(SensorFaults, GainAndOffsetAreAStraightLine) {
    SensorFaults faults;
    faults.gain = 1.2;
    faults.offset = -0.5;
    const std::vector<double> readings = sensed({0.0, 10.0, -10.0}, faults, time_step_s);
    EXPECT_DOUBLE_EQ(readings[0], -0.5);
    EXPECT_DOUBLE_EQ(readings[1], 11.5);
    EXPECT_DOUBLE_EQ(readings[2], -12.5);
}

TEST(SensorFaults, ADriftMovesTheZeroWithTheTimeOfTheSession) {
    SensorFaults faults;
    faults.offset = -0.5;
    faults.drift_by_100_s = 2.0;
    constexpr double run_began_s = 50.0;
    const std::vector<double> readings = sensed({3.0, 3.0, 3.0}, faults, time_step_s, run_began_s);
    for (std::size_t k = 0; k < readings.size(); ++k)
        EXPECT_NEAR(readings[k], 3.0 - 0.5 + 1.0 + 0.02 * time_step_s * static_cast<double>(k), 1e-12);
}

TEST(SensorFaults, AClippedReadingIsNoLargerThanItsLimitEitherWay) {
    SensorFaults faults;
    faults.gain = 2.0;
    faults.limit = 3.0;
    EXPECT_EQ(sensed({0.5, 1.4, 1.6, 9.0, -1.4, -9.0}, faults, time_step_s),
              (std::vector<double>{1.0, 2.8, 3.0, 3.0, -2.8, -3.0}));
}

TEST(SensorFaults, QuantisedReadingsAreTheNearestMultiples) {
    SensorFaults faults;
    faults.step = 0.25;
    EXPECT_EQ(sensed({0.1, 0.13, -0.37, 1.0}, faults, time_step_s),
              (std::vector<double>{0.0, 0.25, -0.25, 1.0}));
}

// Of a first-order sensor: r - rate * lag * (1 - exp(-t / lag)).
TEST(SensorFaults, ALagTrailsARampByTheRampOverItsTimeConstant) {
    for (const double lag_s : {0.2 * time_step_s, 3.0 * time_step_s, 0.05}) {
        SensorFaults faults;
        faults.lag_s = lag_s;
        const std::vector<double> signal = ramp(40);
        const double rate_per_s = (signal[1] - signal[0]) / time_step_s;
        const std::vector<double> readings = sensed(signal, faults, time_step_s);
        for (std::size_t k = 0; k < signal.size(); ++k) {
            const double time_s = static_cast<double>(k) * time_step_s;
            EXPECT_NEAR(readings[k], signal[k] + rate_per_s * lag_s * std::expm1(-time_s / lag_s), 1e-12)
                << k;
        }
    }
}

TEST(SensorFaults, ALagForgetsAJumpExponentially) {
    SensorFaults faults;
    faults.lag_s = 0.05;
    std::vector<double> jump(40, 1.0);
    jump[0] = 0.0;
    const std::vector<double> readings = sensed(jump, faults, time_step_s);
    // From the sample before it to the one after it the jump bends the signal.
    for (std::size_t k = 3; k < jump.size(); ++k) {
        EXPECT_NEAR((1.0 - readings[k]) / (1.0 - readings[k - 1]), std::exp(-time_step_s / 0.05), 1e-12) << k;
    }
}

TEST(SensorFaults, ADelayedRampIsTheRampLater) {
    SensorFaults late;
    late.delay_s = 2.5 * time_step_s;
    const std::vector<double> after = sensed(ramp(10), late, time_step_s);
    SensorFaults early;
    early.delay_s = -2.5 * time_step_s;
    const std::vector<double> before = sensed(ramp(10), early, time_step_s);
    for (int k = 0; k < 10; ++k) {
        EXPECT_NEAR(after[static_cast<std::size_t>(k)], 2.0 * std::max(k - 2.5, 0.0), 1e-12) << k;
        EXPECT_NEAR(before[static_cast<std::size_t>(k)], 2.0 * std::min(k + 2.5, 9.0), 1e-12) << k;
    }
}

// Of x = t^2 / 2 a lag T makes x - T t + T^2, a delay T makes x - T t + T^2 / 2.
TEST(SensorFaults, AShortLagAndAShortDelayDifferWhereTheSignalIsCurved) {
    std::vector<double> parabola;
    for (int k = 0; k < 40; ++k) parabola.push_back(0.5 * std::pow(k * time_step_s, 2.0));
    for (const double samples : {0.05, 1.0 / 3.0, 0.8, 1.3}) {
        const double late_s = samples * time_step_s;
        const std::vector<double> lagged = sensed(parabola, {.lag_s = late_s}, time_step_s);
        const std::vector<double> delayed = sensed(parabola, {.delay_s = late_s}, time_step_s);
        // By the 35th sample the longest lag has forgotten where it began; the last sample has one neighbour.
        for (std::size_t k = 35; k < 39; ++k) {
            const double straight = parabola[k] - late_s * static_cast<double>(k) * time_step_s;
            EXPECT_NEAR(lagged[k], straight + late_s * late_s, 1e-12) << samples;
            EXPECT_NEAR(delayed[k], straight + 0.5 * late_s * late_s, 1e-12) << samples;
        }
    }
}

// 1 / (1 + i w T), once the beginning is forgotten. With 12 samples a period the cubic is off the swing by at
// most 0.0025, a straight line by 0.033.
TEST(SensorFaults, ALagOfASwingIsThatOfAFirstOrderLowPass) {
    constexpr double samples_a_period = 12.0;
    const double speed_rad_per_s = 2.0 * std::numbers::pi / (samples_a_period * time_step_s);
    std::vector<double> swing;
    for (int k = 0; k < 2000; ++k) swing.push_back(std::sin(speed_rad_per_s * k * time_step_s));
    for (const double samples : {0.3, 1.0, 5.0, 50.0}) {
        const double turned_rad = speed_rad_per_s * samples * time_step_s;
        const std::vector<double> readings = sensed(swing, {.lag_s = samples * time_step_s}, time_step_s);
        for (std::size_t k = 1900; k < 1999; ++k) {
            const double time_s = static_cast<double>(k) * time_step_s;
            const double expected =
                std::sin(speed_rad_per_s * time_s - std::atan(turned_rad)) / std::hypot(1.0, turned_rad);
            EXPECT_NEAR(readings[k], expected, 0.0025) << samples << " " << k;
        }
    }
}

TEST(SensorFaults, HysteresisTrailsASlowCycleByHalfTheLoopEitherWay) {
    SensorFaults faults;
    faults.hysteresis = 0.5;
    std::vector<double> cycle;
    for (int k = 0; k < 200; ++k) cycle.push_back(0.05 * k);
    for (int k = 200; k > 0; --k) cycle.push_back(0.05 * k);
    const std::vector<double> readings = sensed(cycle, faults, time_step_s);
    EXPECT_NEAR(readings[100], cycle[100] - 0.5, 1e-3);
    EXPECT_NEAR(readings[300], cycle[300] + 0.5, 1e-3);
}

// Up and down again in steps of 0.01.
std::vector<double> up_and_down(int steps) {
    std::vector<double> cycle;
    for (int k = 0; k < steps; ++k) cycle.push_back(0.01 * k);
    for (int k = steps; k >= 0; --k) cycle.push_back(0.01 * k);
    return cycle;
}

TEST(SensorFaults, HysteresisWithoutAnExponentIsAPlay) {
    const SensorFaults faults{.hysteresis = 0.5, .loop_exponent = 0.0};
    const std::vector<double> cycle = up_and_down(1000);
    const std::vector<double> readings = sensed(cycle, faults, time_step_s);
    // The friction of the cell begins unbent, as a play does in its middle.
    double play = cycle.front();
    for (std::size_t k = 0; k < cycle.size(); ++k) {
        play = std::clamp(play, cycle[k] - 0.5, cycle[k] + 0.5);
        EXPECT_NEAR(readings[k], play, 1e-12) << k;
    }
}

TEST(SensorFaults, HysteresisOfRayleighClosesAlongAParabolaOverTwiceTheLoop) {
    const double half_width = 0.5;
    const SensorFaults faults{.hysteresis = half_width, .loop_exponent = 0.5};
    constexpr std::size_t reversal = 1000;
    const std::vector<double> cycle = up_and_down(reversal);
    const std::vector<double> readings = sensed(cycle, faults, time_step_s);
    for (const double back : {0.0, 0.25, 0.5, 1.0, 1.75, 2.0, 3.0}) {
        const auto k = reversal + static_cast<std::size_t>(std::lround(back / 0.01));
        const double left = std::max(0.0, 1.0 - back / (4.0 * half_width));  // of the way to the other side
        EXPECT_NEAR(readings[k] - cycle[k], half_width * (1.0 - 2.0 * left * left), 1e-9) << back;
    }
}

TEST(SensorFaults, HysteresisNeverMovesAReadingAgainstTheSignal) {
    constexpr double rounding = 1e-15;
    for (const double exponent : {0.0, 0.2, 0.5, 1.0, 1.6}) {
        const SensorFaults faults{.hysteresis = 0.5, .loop_exponent = exponent};
        const std::vector<double> cycle = up_and_down(1000);
        const std::vector<double> readings = sensed(cycle, faults, time_step_s);
        for (std::size_t k = 1; k < cycle.size(); ++k) {
            const double moved = readings[k] - readings[k - 1];
            EXPECT_GE(moved * (cycle[k] - cycle[k - 1]), -rounding) << exponent << " " << k;
        }
    }
}

TEST(SensorFaults, ASignalThatStandsStillIsReadAsItIs) {
    const SensorFaults slow{.hysteresis = 0.5, .lag_s = 0.1, .delay_s = 0.03};
    const std::vector<double> still(5, 7.0);
    for (const double reading : sensed(still, slow, time_step_s)) EXPECT_NEAR(reading, 7.0, 1e-12);
}

}  // namespace
}  // namespace capstan
