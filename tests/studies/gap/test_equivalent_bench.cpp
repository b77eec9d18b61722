#include <gtest/gtest.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"
#include "capstan/gap/bench_channels.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

TEST(EquivalentBench, OfABenchOfKnownGeometryIsTheRecordingItself) {
    const Recording recording = driven_session();
    const Recording bench = equivalent_bench(recording, recording);
    EXPECT_EQ(bench.mode, recording.mode);
    EXPECT_EQ(bench.nominal->dynamic_friction, recording.nominal->dynamic_friction);
    EXPECT_EQ(bench.runs[0].values, recording.runs[0].values);
}

TEST(EquivalentBench, OfADriveHasItsFrictionStiffnessPretensionAndRatio) {
    const LumpedTruth truth{.motor_torque_sign = -1.0};
    const Recording recording = lumped_session(truth);
    const Recording bench = equivalent_bench(recording, recording);
    ASSERT_EQ(bench.mode, BenchMode::pull_pull);
    const NominalBench& nominal = *bench.nominal;
    const double radius_m = nominal.motor_radius_m;
    EXPECT_NEAR(nominal.dynamic_friction, truth.friction_exponent, 0.01);
    EXPECT_NEAR(nominal.axial_stiffness_N * radius_m * radius_m, truth.stiffness_Nm_per_rad, 0.1);
    EXPECT_NEAR(*bench.runs[0].pretension_N * radius_m, truth.pretension_Nm, 0.02);
    EXPECT_NEAR(nominal.load_radius_m / radius_m, truth.speed_ratio, 0.01);
}

// The bench's own model, moved by the bench's inputs, gives the measured torque with the drive's sign
// removed.
TEST(EquivalentBench, OfADriveMovesAndPullsAsTheDriveDoes) {
    const Recording recording = lumped_session({.motor_torque_sign = -1.0});
    const Recording bench = equivalent_bench(recording, recording);
    const TwinRun predicted = EffectsTwin(bench, {}).run(1, {});
    const auto torque = static_cast<std::size_t>(*bench.channel("motor_torque"));
    const std::size_t settled = predicted.values[torque].size() / 2;
    for (std::size_t sample = settled; sample < predicted.values[torque].size(); ++sample) {
        EXPECT_NEAR(bench.runs[1].values[torque][sample], -recording.runs[1].values[0][sample], 1e-12);
        EXPECT_NEAR(predicted.values[torque][sample], bench.runs[1].values[torque][sample], 0.02);
    }
}

// A lumped drive whose ratio was read off its motion wrongly by this factor.
Recording drive_with_misread_ratio(const LumpedTruth& truth, double factor) {
    Recording bench = as_bench(lumped_session(truth),
                               {.bench = equivalent_pair(truth.friction_exponent, truth.stiffness_Nm_per_rad,
                                                         factor * truth.speed_ratio),
                                .pretension_N = truth.pretension_Nm / equivalent_motor_radius_m});
    for (Channel& channel : bench.channels) channel.noise_std = 1e-3;
    return bench;
}

double fitted_radius_ratio(const Recording& bench) {
    const BenchKnowledge undescribed = undescribed_bench(bench);
    const CauseFitter fitter(bench, {.segments = 24, .stride = 1}, 0);
    return bench_numbers(fitter.fit(nominal_hypothesis(undescribed), {}).hypothesis()).load_radius_ratio;
}

// Cables that stretch against a spring shorten the motion as a larger load pulley does; torques tell the two
// apart.
TEST(EquivalentBench, TheRadiusOfItsLoadPulleyFloats) {
    constexpr double misread = 1.05;
    EXPECT_NEAR(
        fitted_radius_ratio(drive_with_misread_ratio({.load_spring_Nm_per_rad = 3.0}, misread)) * misread,
        1.0, 0.01);
}

// An error of a percent is many times the noise of an encoder.
TEST(EquivalentBench, TheRadiusOfItsLoadPulleyFloatsUnderAConstantLoadToo) {
    constexpr double misread = 1.01;
    EXPECT_NEAR(fitted_radius_ratio(drive_with_misread_ratio({}, misread)) * misread, 1.0, 0.001);
}

// Under a constant load the motion tells the ratio to some percent; a spring stretches the cables most where
// the load turns most.
TEST(EquivalentBench, TheRadiusOfItsLoadPulleyIsKnownBetterWhereNoSpringHoldsTheLoad) {
    const auto uncertainty = [](const LumpedTruth& truth) {
        const std::vector<FloatingNumber> numbers =
            undescribed_bench(drive_with_misread_ratio(truth, 1.0)).numbers;
        return std::find_if(
                   numbers.begin(), numbers.end(),
                   [](const FloatingNumber& number) { return number.name == "radius of the load pulley"; })
            ->prior_std;
    };
    EXPECT_GT(uncertainty({.load_spring_Nm_per_rad = 3.0}), 3.0 * uncertainty({}));
}

TEST(BenchEquivalence, DescribesRunsThatItWasNotFittedTo) {
    const Recording recording = lumped_session({.motor_torque_sign = -1.0});
    Recording first = recording;
    first.runs.pop_back();
    Recording second = recording;
    second.runs.erase(second.runs.begin());
    const BenchEquivalence equivalence = fit_equivalence(first);
    EXPECT_EQ(equivalence.motor_torque_sign, -1.0);
    const Recording bench = as_bench(second, equivalence);
    EXPECT_EQ(bench.nominal->axial_stiffness_N, equivalence.bench.axial_stiffness_N);
    EXPECT_EQ(bench.runs[0].values, equivalent_bench(recording, first).runs[1].values);
}

TEST(BenchEquivalence, OfABenchOfKnownGeometryIsRejected) {
    EXPECT_THROW(fit_equivalence(driven_session()), InvalidInput);
}

TEST(EquivalentBench, OfABandWithoutItsTensionsIsRejected) {
    Recording recording = driven_session();
    recording.mode = BenchMode::capstan_band;
    EXPECT_THROW(equivalent_bench(recording, recording), InvalidInput);
}

}  // namespace
}  // namespace capstan::gap
