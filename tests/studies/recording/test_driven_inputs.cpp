#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "capstan/recording/driven_inputs.h"

namespace capstan {
namespace {

constexpr double rate_Hz = 200.0;

std::vector<double> sampled(const std::function<double(double)>& signal) {
    std::vector<double> samples;
    for (int sample = 0; sample < 1000; ++sample) samples.push_back(signal(sample / rate_Hz));
    return samples;
}

double rms_error(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

std::vector<double> with_noise(std::vector<double> samples, double noise_std) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0.0, noise_std);
    for (double& sample : samples) sample += normal(random);
    return samples;
}

TEST(DrivenInputs, ASlowRampLosesMostOfItsNoise) {
    const auto ramp = sampled([](double t) { return 0.1 * t; });
    const auto noisy = with_noise(ramp, 0.01);
    EXPECT_LT(rms_error(smoothed(noisy, 0.01), ramp), 0.45 * rms_error(noisy, ramp));
}

TEST(DrivenInputs, ACornerStaysWhereItIs) {
    // A ramp of 0.1 a second that stops: smoothing over it would round it by thousands of noises.
    const auto corner = sampled([](double t) { return 0.1 * std::min(t, 2.5); });
    EXPECT_LT(rms_error(smoothed(corner, 1e-6), corner), 1e-6);
}

TEST(DrivenInputs, FastMotionIsNotFlattened) {
    const auto sine = sampled([](double t) { return 0.3 * std::sin(2.0 * std::numbers::pi * 5.0 * t); });
    EXPECT_LT(rms_error(smoothed(with_noise(sine, 0.001), 0.001), sine), 0.0011);
}

TEST(DrivenInputs, EncoderStepsOfASlowMotionAreSmoothedOut) {
    constexpr double step = 1.57e-4;
    const auto motion = sampled([](double t) { return 0.02 * t; });
    auto counted = motion;
    for (double& value : counted) value = step * std::round(value / step);
    EXPECT_LT(rms_error(smoothed(counted, step / std::sqrt(12.0)), motion), 0.4 * rms_error(counted, motion));
}

TEST(DrivenInputs, WithoutStatedNoiseSamplesStayAsTheyAre) {
    const auto noisy = with_noise(std::vector<double>(100, 1.0), 0.1);
    EXPECT_EQ(smoothed(noisy, 0.0), noisy);
}

TEST(DrivenInputs, AnotherMeasurementDiffersFromTheFirstAsThatDoesFromTheMotion) {
    constexpr double noise = 0.003;
    const auto motion = sampled([](double t) { return 0.3 * std::sin(2.0 * std::numbers::pi * t); });
    Recording recording;
    recording.channels = {{"load_angle", "rad", noise, {}}};
    RecordedRun run;
    run.output = OutputKind::handle;
    run.driven = {"load_angle"};
    run.values = {with_noise(motion, noise)};
    const auto once = driven_inputs(recording, run).values[0];
    const auto again = driven_inputs_again(recording, run, 0).values[0];
    EXPECT_NEAR(rms_error(again, once) / rms_error(once, motion), 1.0, 0.35);
    EXPECT_EQ(driven_inputs_again(recording, run, 0).values[0], again);
}

}  // namespace
}  // namespace capstan
