#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "capstan/gap/effects_twin.h"
#include "capstan/gap_trial/trial_case.h"
#include "capstan/recording/recording_reader.h"
#include "sample_session.h"
#include "scratch_folder.h"

namespace capstan::gap_trial {
namespace {

Recording recorded_without_an_effect(BenchKind kind) {
    TrialStream draws(3, 1, DrawTopic::bench);
    TrialStream motion(3, 1, DrawTopic::motion);
    TrialStream noise(3, 1, DrawTopic::noise);
    const TrialBench bench = make_trial_bench(kind, 0.05, draws);
    const std::vector<TrialRun> runs = draw_session(bench, RecordingLength::standard, motion);
    std::vector<SensedRun> logged;
    for (const SensedRun& run : sensed_with(bench, runs, {}))
        logged.push_back(with_noise(bench, run, {}, noise));
    const ScratchFolder folder;
    write_recording(folder.path(), "none", bench, runs, logged);
    return read_recording(folder.path() / "none.csv");
}

// RMS of recorded minus the engine's model, by run, in one channel.
std::vector<double> missed_by_the_twin(BenchKind kind, const std::string& channel) {
    const Recording recording = recorded_without_an_effect(kind);
    const gap::EffectsTwin twin(recording, {100, 1});
    const auto index = static_cast<std::size_t>(*recording.channel(channel));
    std::vector<double> missed;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const std::vector<double> model = twin.run(run, {}).values[index];
        double squares = 0.0;
        for (std::size_t k = 0; k < model.size(); ++k)
            squares += std::pow(recording.runs[run].values[index][k] - model[k], 2);
        missed.push_back(std::sqrt(squares / static_cast<double>(model.size())));
    }
    return missed;
}

// How much earlier than the engine's model a recorded channel of a run is, by least squares on the model's
// rate [s].
double lead_of_twin_s(const Recording& recording, std::size_t run, const std::string& channel) {
    const gap::EffectsTwin twin(recording, {100, 1});
    const auto index = static_cast<std::size_t>(*recording.channel(channel));
    const std::vector<double> model = twin.run(run, {}).values[index];
    double product = 0.0;
    double squares = 0.0;
    for (std::size_t k = 1; k + 1 < model.size(); ++k) {
        const double rate = 0.5 * (model[k + 1] - model[k - 1]) * recording.sample_rate_Hz;
        product += rate * (recording.runs[run].values[index][k] - model[k]);
        squares += rate * rate;
    }
    return product / squares;
}

// Two models of the same bench that share no code: lumped masses in time, and the engine's quasi-static step.
TEST(LumpedBench, WithoutAnEffectTheEnginesTwinAgrees) {
    // ramp_locked, tunnel, sines, steps_dwell: ringing and inertia are left where it moves [N m].
    const std::vector<double> wide = missed_by_the_twin(BenchKind::uniform_wide, "load_torque");
    ASSERT_EQ(wide.size(), 4U);
    EXPECT_LT(wide[0], 6e-3);
    EXPECT_LT(wide[1], 12e-3);
    EXPECT_LT(wide[2], 12e-3);
    EXPECT_LT(wide[3], 6e-3);
    // tunnel, sines, ramp_locked, of torques up to 4 N m
    const std::vector<double> tight = missed_by_the_twin(BenchKind::uniform_tight, "load_torque");
    ASSERT_EQ(tight.size(), 3U);
    EXPECT_LT(tight[0], 30e-3);
    EXPECT_LT(tight[1], 30e-3);
    EXPECT_LT(tight[2], 6e-3);
    for (const double missed_Nm : missed_by_the_twin(BenchKind::single_cable, "load_torque"))
        EXPECT_LT(missed_Nm, 12e-3);
    for (const double missed_rad : missed_by_the_twin(BenchKind::one_bend, "motor_angle"))
        EXPECT_LT(missed_rad, 2e-3);
}

// E72. The lumped cable loses what it does by a law of its own, a relaxing branch.
TEST(LumpedBench, ItsTorquesComeBeforeThoseOfATwinWithoutCableLosses) {
    constexpr std::size_t sines = 2;
    Recording recording = recorded_without_an_effect(BenchKind::uniform_wide);
    const double with_losses_s = lead_of_twin_s(recording, sines, "load_torque");
    recording.nominal->is_equivalent = true;  // a drive whose cables are not described has none
    const double without_s = lead_of_twin_s(recording, sines, "load_torque");
    RecordProperty("lead_with_losses_ms", std::to_string(1e3 * with_losses_s));
    RecordProperty("lead_without_ms", std::to_string(1e3 * without_s));
    EXPECT_GT(without_s, 0.3e-3);
    EXPECT_LT(std::abs(with_losses_s), 0.7 * without_s) << "the usual losses are a half of this cable's";
}

TEST(LumpedBench, RestsUntilItIsDriven) {
    TrialStream draws(1, 1, DrawTopic::bench);
    const TrialBench bench = make_trial_bench(BenchKind::uniform_wide, 1.0, draws);
    TrialRun still = sample_session(bench).front();
    still.motor_torque_Nm.assign(still.load_angle_rad.size(), 0.0);
    const TrueRun truth = run_lumped_bench(bench, still, {});
    for (const double angle_rad : truth.values[1]) EXPECT_EQ(angle_rad, 0.0);
    for (const double torque_Nm : truth.values[3]) EXPECT_EQ(torque_Nm, 0.0);
}

// The pair is symmetric: turned the other way, everything turns round.
TEST(LumpedBench, MirroredInputsMirrorTheBench) {
    TrialStream draws(1, 1, DrawTopic::bench);
    TrialBench bench = make_trial_bench(BenchKind::one_bend, 1.0, draws);
    bench.tension_sensors.clear();
    TrialRun run = sample_session(bench).back();
    const TrueRun one_way = run_lumped_bench(bench, run, {});
    for (double& angle_rad : run.load_angle_rad) angle_rad = -angle_rad;
    const TrueRun other_way = run_lumped_bench(bench, run, {});
    for (std::size_t channel = 1; channel < 4; ++channel) {
        for (std::size_t k = 0; k < one_way.values[channel].size(); ++k)
            ASSERT_NEAR(one_way.values[channel][k], -other_way.values[channel][k], 1e-9);
    }
}

}  // namespace
}  // namespace capstan::gap_trial
