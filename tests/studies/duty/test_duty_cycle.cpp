#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "capstan/cable/invalid_input.h"
#include "capstan/duty/duty_cycle.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::duty {
namespace {

constexpr double sample_rate_Hz = 100.0;

// One cable, 2 m at 0.7 m, its far end held; the motor angle over time is given.
Recording single_cable(const std::vector<double>& motor_angle_rad, double dynamic_friction) {
    Recording recording;
    recording.name = "single cable";
    recording.mode = BenchMode::single_cable;
    recording.sample_rate_Hz = sample_rate_Hz;
    recording.channels = {{"motor_angle", "rad", {}, {}}};
    NominalBench bench;
    bench.curvature = {{2.0, 0.7}};
    bench.motor_radius_m = 0.02;
    bench.load_radius_m = 0.02;
    bench.axial_stiffness_N = 2000.0;
    bench.dynamic_friction = dynamic_friction;
    bench.static_friction = dynamic_friction;
    recording.nominal = bench;
    RecordedRun run;
    run.number = 1;
    run.pretension_N = 10.0;
    run.output = OutputKind::locked;
    run.driven = {"motor_angle"};
    for (std::size_t k = 0; k < motor_angle_rad.size(); ++k)
        run.time_s.push_back(static_cast<double>(k) / sample_rate_Hz);
    run.values = {motor_angle_rad};
    recording.runs = {run};
    return recording;
}

// 1 s at rest, then four turns of a sine of one second each.
std::vector<double> rest_then_sine(double amplitude_rad) {
    std::vector<double> angle_rad(101, 0.0);
    for (int k = 1; k <= 400; ++k)
        angle_rad.push_back(amplitude_rad * std::sin(2.0 * std::numbers::pi * k / 100.0));
    return angle_rad;
}

DutyOptions still_below(double speed_m_per_s) {
    DutyOptions options;
    options.still_m_per_s = speed_m_per_s;
    return options;
}

TEST(DutyCycle, TheTimesOfARunSumToItsLength) {
    const Recording recording = single_cable(rest_then_sine(0.2), 0.2);
    const DutyCycle duty = measure_duty(recording, {});
    EXPECT_NEAR(duty.all.total_s(), 5.0, 1e-9);
    EXPECT_NEAR(duty.runs.front().total_s(), 5.0, 1e-9);
    EXPECT_GE(duty.all.still_s, 1.0 - 1e-9);
}

// Without friction tension is the same all along, and any motion reaches the far end.
TEST(DutyCycle, ACableWithoutFrictionOnlyKnowsMassMotion) {
    const DutyCycle duty = measure_duty(single_cable(rest_then_sine(0.2), 0.0), {});
    EXPECT_EQ(duty.fraction(Regime::mass), 1.0);
}

// A motion too small to overcome friction to the end stays a partial one at the motor.
TEST(DutyCycle, ASmallMotionStaysAtTheProximalEnd) {
    const DutyCycle duty = measure_duty(single_cable(rest_then_sine(0.02), 0.3), still_below(1e-6));
    EXPECT_EQ(duty.fraction(Regime::partial_proximal), 1.0);
}

// After a reversal the front has to creep along the cable before all of it slides: the wider the more
// friction.
TEST(DutyCycle, MoreFrictionMeansMorePartialMotion) {
    const DutyCycle slippery = measure_duty(single_cable(rest_then_sine(0.4), 0.05), {});
    const DutyCycle rough = measure_duty(single_cable(rest_then_sine(0.4), 0.2), {});
    EXPECT_GT(rough.fraction(Regime::partial_proximal), slippery.fraction(Regime::partial_proximal));
    EXPECT_GT(rough.fraction(Regime::mass), 0.0);
}

TEST(DutyCycle, ADriveThatNeverMovedHasNone) {
    const DutyCycle duty = measure_duty(single_cable(rest_then_sine(0.2), 0.2), still_below(10.0));
    EXPECT_NEAR(duty.all.still_s, 5.0, 1e-9);
    EXPECT_THROW(duty.fraction(Regime::mass), InvalidInput);
}

TEST(DutyCycle, APlanTakesTheFractionsOfItsRegimes) {
    DutyCycle duty;
    duty.all.regime_s = {3.0, 1.0, 0.0, 1.0};  // mass, proximal, distal, both
    StudyPlan plan;
    plan.regimes = {{Regime::partial_proximal, {1}, 0.5}, {Regime::mass, {2}, 0.5}};
    EXPECT_NEAR(use_duty(duty, plan), 0.2, 1e-15);
    EXPECT_DOUBLE_EQ(plan.regimes[0].duty_fraction, 0.25);
    EXPECT_DOUBLE_EQ(plan.regimes[1].duty_fraction, 0.75);
    plan.regimes = {{Regime::partial_distal, {1}, 1.0}};
    EXPECT_THROW(use_duty(duty, plan), InvalidInput);
}

TEST(DutyCycle, ABenchWithoutGeometryIsRefused) {
    Recording recording = single_cable(rest_then_sine(0.2), 0.2);
    recording.mode = BenchMode::capstan_band;
    EXPECT_THROW(measure_duty(recording, {}), InvalidInput);
}

// Ramps against a locked load are in partial motion for much of their time, a moved handle almost never.
TEST(DutyCycle, DistinguishesRampsFromAHandleInARecording) {
    const std::filesystem::path path = std::filesystem::path(CAPSTAN_OPEN_RECORDINGS) / "open01.csv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    const DutyCycle duty = measure_duty(read_recording(path), {});
    ASSERT_EQ(duty.runs.size(), 4u);
    const auto proximal_fraction = [&](std::size_t run) {
        return duty.runs[run].regime_s[static_cast<std::size_t>(Regime::partial_proximal)] /
               duty.runs[run].moving_s();
    };
    EXPECT_GT(proximal_fraction(0), 0.4);                           // ramp_locked
    EXPECT_LT(proximal_fraction(1), 0.1);                           // tunnel, by a handle
    EXPECT_GT(duty.runs[3].still_s, 0.9 * duty.runs[3].total_s());  // steps_dwell
}

}  // namespace
}  // namespace capstan::duty
