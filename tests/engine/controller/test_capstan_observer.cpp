#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "capstan/cable/conduit.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/controller/capstan_observer.h"
#include "capstan/controller/observer.h"
#include "solver/allocation_count.h"

namespace capstan {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct CObserver : public testing::Test {
    capstan_status create() {
        return capstan_observer_create(storage.get(), bytes, &cable, sensors.data(), sensors.size(),
                                       &settings, message, sizeof message, &observer);
    }
    ~CObserver() override { capstan_observer_destroy(observer); }

    std::vector<double> readings_at(int sample) const {
        const double phase = 0.01 * sample;
        return {0.002 * (1.0 - std::cos(phase)), 20.0 + 10.0 * std::sin(phase), 1e-4 * std::sin(0.7 * phase)};
    }

    std::vector<capstan_bend> bends = {{M_PI, 0.1, 0.3}};
    capstan_cable cable{1.2, bends.data(), bends.size(), 9e3, 0.12, 0.15, 20.0, 12};
    std::vector<capstan_sensor> sensors = {{CAPSTAN_TENSION, 0.1}, {CAPSTAN_LOAD_DISPLACEMENT, 0.0}};
    capstan_observer_settings settings = [] {
        capstan_observer_settings usual = capstan_observer_defaults();
        usual.noise_N = 0.3;
        return usual;
    }();
    std::size_t bytes = capstan_observer_bytes();
    std::unique_ptr<void, void (*)(void*)> storage{std::malloc(capstan_observer_bytes()), std::free};
    char message[300];
    capstan_observer* observer = nullptr;
    std::vector<double> mean_N = std::vector<double>(13), low_N = mean_N, high_N = mean_N;
};

TEST_F(CObserver, HasTheBitsOfTheObserverInCpp) {
    ASSERT_EQ(create(), CAPSTAN_OK) << message;
    const Cable same({.curvature = pieces_of({{M_PI, 0.1, 0.3}}, 1.2),
                      .segments = 12,
                      .axial_stiffness_N = 9e3,
                      .dynamic_friction = 0.12,
                      .static_friction = 0.15,
                      .pretension_N = 20.0});
    Observer other(same, {{false, 0.1}, {true, 0.0}}, {.noise_N = 0.3});
    std::vector<double> expected_N(39);
    const std::span<double> all(expected_N);
    for (int sample = 1; sample <= 500; ++sample) {
        const std::vector<double> readings = readings_at(sample);
        ASSERT_EQ(capstan_observer_update(observer, 0.001 * sample, readings.data(), mean_N.data(),
                                          low_N.data(), high_N.data()),
                  CAPSTAN_OK);
        other.update(0.001 * sample, readings);
        other.write_estimate(all.subspan(0, 13), all.subspan(13, 13), all.subspan(26, 13));
        for (std::size_t node = 0; node < 13; ++node) {
            ASSERT_EQ(mean_N[node], expected_N[node]);
            ASSERT_EQ(low_N[node], expected_N[13 + node]);
            ASSERT_EQ(high_N[node], expected_N[26 + node]);
        }
    }
}

// The speed is that of the samples' times: ten times slower, the same motion meets a tenth of the drag.
TEST_F(CObserver, HasFrictionThatDependsOnTheSpeed) {
    settings.noise_N = 5.0;
    settings.load_wander_m = 0.0;
    const auto lost_N = [&](double drag_N_s_per_m2, double interval_s) {
        settings.drag_N_s_per_m2 = drag_N_s_per_m2;
        EXPECT_EQ(create(), CAPSTAN_OK) << message;
        for (int sample = 0; sample <= 40; ++sample) {
            const double readings[] = {8e-5 * sample, 20.0, 0.0};
            EXPECT_EQ(capstan_observer_update(observer, interval_s * sample, readings, mean_N.data(), nullptr,
                                              nullptr),
                      CAPSTAN_OK);
        }
        capstan_observer_destroy(observer);
        observer = nullptr;
        return mean_N.front() - mean_N.back();
    };
    const double without_N = lost_N(0.0, 0.001);
    const double slow_N = lost_N(40.0, 0.01) - without_N;
    const double fast_N = lost_N(40.0, 0.001) - without_N;
    EXPECT_GT(slow_N, 0.0);
    EXPECT_GT(fast_N, 5.0 * slow_N);
    settings.extra_friction = 0.05;
    settings.speed_m_per_s = 0.0;
    EXPECT_EQ(create(), CAPSTAN_WRONG_INPUT);
    EXPECT_NE(std::string(message).find("speed_m_per_s"), std::string::npos) << message;
}

// The drag also: it moves the cables twice.
TEST_F(CObserver, AllocatesNothingAfterItsCreation) {
    settings.drag_N_s_per_m2 = 20.0;
    settings.extra_friction = 0.05;
    ASSERT_EQ(create(), CAPSTAN_OK) << message;
    const long before = test::allocations();
    const double absurd[] = {1e300, 0.0, 0.0};
    for (int sample = 1; sample <= 3000; ++sample) {
        const double phase = 0.01 * sample;  // also slack and against the load
        const double readings[] = {0.02 * std::sin(phase), 20.0 + 10.0 * std::sin(phase),
                                   0.01 * std::sin(2.3 * phase)};
        EXPECT_EQ(
            capstan_observer_update(observer, 0.001 * sample, readings, mean_N.data(), nullptr, nullptr),
            CAPSTAN_OK);
        EXPECT_EQ(capstan_observer_update(observer, 0.001 * sample, readings, nullptr, nullptr, nullptr),
                  CAPSTAN_TIME_NOT_RISING);
        EXPECT_EQ(capstan_observer_update(observer, 1e3 + sample, absurd, nullptr, nullptr, nullptr),
                  CAPSTAN_READING_NOT_FINITE);
    }
    EXPECT_EQ(test::allocations(), before);
}

TEST_F(CObserver, SaysEverythingThatIsWrong) {
    cable.friction = -1.0;
    EXPECT_EQ(create(), CAPSTAN_WRONG_INPUT);
    EXPECT_NE(std::string(message).find("friction"), std::string::npos) << message;
    cable.friction = 0.12;
    sensors = {{CAPSTAN_TENSION, 5.0}, {CAPSTAN_LOAD_DISPLACEMENT, 0.0}, {CAPSTAN_LOAD_DISPLACEMENT, 0.0}};
    settings.noise_N = 0.0;
    EXPECT_EQ(create(), CAPSTAN_WRONG_INPUT);
    for (const char* words : {"sensors[0]", "two measure", "noise_N"})
        EXPECT_NE(std::string(message).find(words), std::string::npos) << message;
    EXPECT_EQ(observer, nullptr);
}

TEST_F(CObserver, CutsItsMessageOffWhereTheCallersMemoryEnds) {
    cable.length_m = nan;
    char small[8] = "1234567";
    EXPECT_EQ(capstan_observer_create(storage.get(), bytes, &cable, sensors.data(), sensors.size(), &settings,
                                      small, 5, &observer),
              CAPSTAN_WRONG_INPUT);
    EXPECT_EQ(std::string(small).size(), 4U);
    EXPECT_EQ(small[5], '6');
}

TEST_F(CObserver, RefusesMissingPointersAndSmallStorage) {
    bytes -= 1;
    EXPECT_EQ(create(), CAPSTAN_STORAGE_TOO_SMALL);
    bytes += 1;
    EXPECT_EQ(capstan_observer_create(nullptr, bytes, &cable, nullptr, 0, &settings, nullptr, 0, &observer),
              CAPSTAN_NULL_ARGUMENT);
    EXPECT_EQ(
        capstan_observer_create(storage.get(), bytes, &cable, nullptr, 2, &settings, nullptr, 0, &observer),
        CAPSTAN_NULL_ARGUMENT);
    EXPECT_EQ(capstan_observer_update(nullptr, 0.0, nullptr, nullptr, nullptr, nullptr),
              CAPSTAN_NULL_ARGUMENT);
    EXPECT_EQ(capstan_observer_nodes(nullptr), 0);
}

TEST_F(CObserver, ARefusedSampleChangesNothing) {
    ASSERT_EQ(create(), CAPSTAN_OK) << message;
    const std::vector<double> good = readings_at(1);
    std::vector<double> bad = good;
    bad[1] = nan;
    EXPECT_EQ(capstan_observer_update(observer, nan, good.data(), nullptr, nullptr, nullptr),
              CAPSTAN_TIME_NOT_RISING);
    EXPECT_EQ(capstan_observer_update(observer, 0.001, bad.data(), nullptr, nullptr, nullptr),
              CAPSTAN_READING_NOT_FINITE);
    EXPECT_EQ(capstan_observer_update(observer, 0.001, good.data(), mean_N.data(), nullptr, nullptr),
              CAPSTAN_OK);
    EXPECT_NEAR(mean_N[0], 20.0, 5.0);
}

// The drag acts against the motion, so that a cable that is reeled in carries less tension away from the
// motor.
TEST(Observer, WithFrictionThatDependsOnSpeedFollowsItAndAllocatesNothing) {
    const Cable cable({.curvature = pieces_of({{M_PI, 0.1, 0.3}}, 1.2),
                       .segments = 12,
                       .axial_stiffness_N = 9e3,
                       .dynamic_friction = 0.12,
                       .static_friction = 0.12,
                       .pretension_N = 20.0});
    const std::vector<ObserverSensor> sensors = {{false, 0.0}, {true, 0.0}};
    Observer plain(cable, sensors, {.noise_N = 5.0});
    ObserverSettings settings{.noise_N = 5.0};
    settings.rate_friction.viscous.drag_N_s_per_m2 = 40.0;
    Observer dragged(cable, sensors, settings);
    const long before = test::allocations();
    for (int sample = 1; sample <= 2000; ++sample) {
        const double reel_m = 0.004 * std::sin(0.02 * sample);
        const double readings[] = {reel_m, 20.0 + 5e3 * reel_m, -0.3 * reel_m};
        plain.update(0.001 * sample, readings);
        dragged.update(0.001 * sample, readings);
    }
    EXPECT_EQ(test::allocations(), before);
    std::vector<double> plain_N(39), dragged_N(39);
    const auto write = [](const Observer& observer, std::span<double> all_N) {
        observer.write_estimate(all_N.subspan(0, 13), all_N.subspan(13, 13), all_N.subspan(26, 13));
    };
    for (int sample = 2001; sample <= 2030; ++sample) {
        const double reel_m = 0.08 * 0.001 * (sample - 2000);
        const double readings[] = {reel_m, 20.0, 0.0};
        plain.update(0.001 * sample, readings);
        dragged.update(0.001 * sample, readings);
    }
    write(plain, plain_N);
    write(dragged, dragged_N);
    EXPECT_GT(dragged_N[0] - dragged_N[12], plain_N[0] - plain_N[12] + 0.5);
}

}  // namespace
}  // namespace capstan
