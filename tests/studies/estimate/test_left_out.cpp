#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimate/left_out.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/sensing/random_stream.h"

namespace capstan::estimate {
namespace {

// A recording that the engine itself made: three sensors, a far end that wanders unseen.
SensedCable simulated_cable(double true_wander_m, double noise_N, int samples) {
    SensedCable cable;
    cable.name = "A";
    cable.specification = {{{2.0, 0.7}}, 20, 4000.0, 0.21, 0.3, 0.0};
    cable.channels = {{"near", 0.2, noise_N}, {"middle", 1.1, noise_N}, {"far", 1.8, noise_N}};
    for (int number = 1; number <= 2; ++number) {
        SensedRun run;
        run.number = number;
        run.pretension_N = 25.0;
        CableSpecification specification = cable.specification;
        specification.pretension_N = run.pretension_N;
        const QuasiStaticStep model(Cable(specification), ModelRules::consistent());
        CableState state = pretensioned(model.cable());
        const double rest_m = state.displacement_m.front();
        run.reading_N.resize(cable.channels.size());
        double distal_m = 0.0;
        for (int k = 0; k < samples; ++k) {
            const auto instant = static_cast<std::uint32_t>(k);
            const auto draw = [&](std::uint32_t what) {
                return standard_normals(
                    {5, RandomPurpose::reading_noise, instant, static_cast<std::uint32_t>(number), what})[0];
            };
            distal_m += true_wander_m * draw(100);
            const double near_m = rest_m - 0.004 * std::sin(0.02 * k * number);
            model.advance(state, {EndCondition::position_m(near_m), EndCondition::position_m(distal_m)});
            run.time_s.push_back(0.005 * k);
            run.ends.push_back({near_m, 0.0});
            for (std::size_t c = 0; c < cable.channels.size(); ++c) {
                const SensorSpot spot = spot_at(model.cable(), cable.channels[c].position_m);
                run.reading_N[c].push_back(tension_at_N(state, spot) +
                                           noise_N * draw(static_cast<std::uint32_t>(c)));
            }
        }
        cable.runs.push_back(std::move(run));
    }
    return cable;
}

TEST(LeaveOut, WithACorrectModelTheErrorIsTheNoiseAndTheBandCovers) {
    const SensedCable cable = simulated_cable(0.0, 0.25, 1500);
    for (const LeftOutChannel& result : leave_out(cable, {0, 1, 2}, {})) {
        EXPECT_NEAR(result.rms_N, 0.25, 0.02) << result.channel;
        EXPECT_GE(result.coverage, 0.93) << result.channel;
        EXPECT_LE(result.coverage, 0.97) << result.channel;
    }
}

// Not so the last sensor before that end, which alone sees the thin layer that its small motions move.
TEST(LeaveOut, TracksAnUnobservedFarEnd) {
    const SensedCable cable = simulated_cable(3e-5, 0.25, 1500);
    for (const LeftOutChannel& result : leave_out(cable, {0, 1}, {})) {
        EXPECT_LT(result.rms_N, 0.5 * result.model_alone_rms_N) << result.channel;
        EXPECT_LT(result.rms_N, 0.5 * result.paper_mean_rms_N) << result.channel;
        EXPECT_GT(result.trust.wander_m, 1e-6) << result.channel;
        EXPECT_GE(result.coverage, 0.90) << result.channel;
    }
}

// What the left-out channel reads must not reach its own prediction or band.
TEST(LeaveOut, APredictionDoesNotUseItsOwnChannel) {
    SensedCable cable = simulated_cable(3e-5, 0.25, 400);
    const LeftOutChannel before = leave_out(cable, {1}, {}).front();
    for (SensedRun& run : cable.runs) {
        for (double& reading_N : run.reading_N[1]) reading_N += 1000.0;
    }
    const LeftOutChannel after = leave_out(cable, {1}, {}).front();
    EXPECT_EQ(before.trust.wander_m, after.trust.wander_m);
    EXPECT_EQ(before.widening, after.widening);
    EXPECT_EQ(before.mean_band_N, after.mean_band_N);
    EXPECT_EQ(after.coverage, 0.0);
}

TEST(LeaveOut, ThreadsChangeNoBit) {
    const SensedCable cable = simulated_cable(3e-5, 0.25, 300);
    TrackingOptions two;
    two.jobs = 2;
    const auto alone = leave_out(cable, {0, 1, 2}, {});
    const auto together = leave_out(cable, {0, 1, 2}, two);
    for (std::size_t k = 0; k < alone.size(); ++k) {
        EXPECT_EQ(alone[k].rms_N, together[k].rms_N);
        EXPECT_EQ(alone[k].coverage, together[k].coverage);
        EXPECT_EQ(alone[k].paper_mean_rms_N, together[k].paper_mean_rms_N);
    }
}

TEST(LeaveOut, OneChannelLeavesNothingToPredictFrom) {
    SensedCable cable = simulated_cable(0.0, 0.25, 50);
    cable.channels.resize(1);
    for (SensedRun& run : cable.runs) run.reading_N.resize(1);
    EXPECT_THROW(leave_out(cable, {0}, {}), InvalidInput);
    EXPECT_FALSE(tune_estimator(cable, {}).widening_known);
}

TEST(SensedCable, RefusesARecordingWithoutTensionsAndSaysWhatToDo) {
    Recording recording;
    recording.name = "bench";
    recording.nominal = NominalBench{};
    recording.channels = {{"motor_angle", "rad", {}, {}}, {"load_angle", "rad", {}, {}}};
    try {
        sensed_cables(recording, 20);
        FAIL();
    } catch (const InvalidInput& refusal) {
        ASSERT_EQ(refusal.problems().size(), 1u);
        EXPECT_NE(refusal.problems()[0].find("tension_sensors"), std::string::npos);
    }
}

bool there(const std::string& file) {
    return std::filesystem::exists(std::string(CAPSTAN_OPEN_RECORDINGS) + "/" + file);
}

// A pair whose model is right: errors are noise, and so is the coverage.
TEST(OpenRecordings, ASensorOfAPairWithoutGapIsPredictedToItsNoise) {
    if (!there("open01.csv")) GTEST_SKIP() << "the open recordings are not on this machine";
    const auto cables =
        sensed_cables(read_recording(std::string(CAPSTAN_OPEN_RECORDINGS) + "/open01.csv"), 40);
    ASSERT_EQ(cables.size(), 1u);
    const LeftOutChannel result = leave_out(cables.front(), {1}, {}).front();
    EXPECT_NEAR(result.rms_N, 0.25, 0.02);
    EXPECT_GE(result.coverage, 0.93);
    EXPECT_LE(result.coverage, 0.97);
}

// A cable much softer at low tension than the model thinks: what the model alone misses by newtons.
TEST(OpenRecordings, ASensorOfACableThatTheModelGetsWrongIsPredictedFromItsNeighbours) {
    if (!there("open14.csv")) GTEST_SKIP() << "the open recordings are not on this machine";
    const auto cables =
        sensed_cables(read_recording(std::string(CAPSTAN_OPEN_RECORDINGS) + "/open14.csv"), 20);
    ASSERT_EQ(cables.front().channels.size(), 7u) << "five sensors and both ends";
    const LeftOutChannel result = leave_out(cables.front(), {2}, {}).front();
    EXPECT_LT(result.rms_N, 0.2 * result.model_alone_rms_N);
    EXPECT_LT(result.rms_N, 0.1 * result.paper_mean_rms_N);
    EXPECT_GE(result.coverage, 0.93);
}

}  // namespace
}  // namespace capstan::estimate
