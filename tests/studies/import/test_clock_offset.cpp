#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "capstan/import/clock_offset.h"

namespace capstan::imports {

namespace {

constexpr double rate_Hz = 200.0;
constexpr double turn = 2.0 * std::numbers::pi;

double motion(double time_s) {
    return std::sin(turn * 0.5 * time_s) + 0.4 * std::sin(turn * 1.3 * time_s + 0.7);
}

// A torque with friction: elastic below a yield, `viscous` N m s on top.
std::vector<double> torque(double delay_s, double viscous, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.01);
    std::vector<double> values;
    double friction = 0.0;
    double last = motion(-2.0);
    for (int k = -400; k < 4000; ++k) {  // 2 s earlier, so that friction knows the motion
        const double now = motion(k / rate_Hz - delay_s);
        friction = std::clamp(friction + 5.0 * (now - last), -0.4, 0.4);
        if (k >= 0) values.push_back(0.5 * now + friction + viscous * (now - last) * rate_Hz + noise(random));
        last = now;
    }
    return values;
}

std::vector<double> angle() {
    std::vector<double> values;
    for (int k = 0; k < 4000; ++k) values.push_back(motion(k / rate_Hz));
    return values;
}

TEST(ClockOffset, IsFoundBehindFriction) {
    for (const double delay_s : {-0.31, -0.02, 0.06, 0.25}) {
        const auto found = find_clock_offset(torque(delay_s, 0.0, 1), {{angle(), true}}, rate_Hz, 1.0, 2e-3);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->offset_s, -delay_s, std::max(1.0 / rate_Hz, found->uncertainty_s));
        EXPECT_LT(found->uncertainty_s, 0.05);
    }
}

TEST(ClockOffset, IsNotSeenInViscousFriction) {
    const auto found = find_clock_offset(torque(0.0, 0.05, 2), {{angle(), true}}, rate_Hz, 1.0, 2e-3);
    ASSERT_TRUE(found);
    EXPECT_LE(std::abs(found->offset_s), std::max(1.0 / rate_Hz, found->uncertainty_s));
}

TEST(ClockOffset, IsExactBetweenAngles) {
    std::vector<double> late;
    for (int k = 0; k < 4000; ++k) late.push_back(-0.7 * motion(k / rate_Hz - 0.0371) + 3.0);
    const auto found = find_clock_offset(late, {{angle(), false}}, rate_Hz, 1.0, 1e-6);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->offset_s, -0.0371, 0.0005);
}

// 168 samples, of which a shift by a third of a second leaves 131: too few for the friction of four channels.
TEST(ClockOffset, OfACopyIsFoundInFewSamples) {
    const auto first_of = [](std::vector<double> values, std::size_t from) {
        return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(from),
                                   values.begin() + static_cast<std::ptrdiff_t>(from + 168));
    };
    std::vector<double> copy;
    for (const double value : torque(0.0, 0.0, 4)) copy.push_back(0.02 * value);
    const std::vector<ClockReference> others = {{first_of(angle(), 200), true},
                                                {first_of(torque(0.3, 0.0, 5), 200), false},
                                                {first_of(torque(0.0, 0.0, 4), 200), false},
                                                {first_of(torque(0.1, 0.0, 6), 200), false}};
    for (const std::size_t late : {168u, 232u}) {
        const auto found = find_clock_offset(first_of(copy, late), others, rate_Hz, 1.0, 2e-3);
        ASSERT_TRUE(found) << late;
        EXPECT_NEAR(found->offset_s, (static_cast<double>(late) - 200.0) / rate_Hz, 1.0 / rate_Hz);
    }
}

TEST(ClockOffset, IsNotInventedForAChannelWithoutCommonMotion) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 1.0);
    std::vector<double> other(4000);
    for (double& value : other) value = noise(random);
    EXPECT_FALSE(find_clock_offset(other, {{angle(), true}}, rate_Hz, 1.0, 2e-3));
}

}  // namespace

}  // namespace capstan::imports
