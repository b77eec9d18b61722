#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "capstan/gap/effects_twin.h"
#include "capstan/gap_trial/rig_motion.h"
#include "capstan/gap_trial/trial_case.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"
#include "scratch_folder.h"

namespace capstan::gap_trial {
namespace {

// A drive as if its laboratory knew it, and had mounted its sensors the engine's way.
void as_known_bench(const Rig& rig, Recording& recording) {
    recording.mode = BenchMode::pull_pull;
    recording.nominal = rig.bench.nominal;
    const auto load_angle = static_cast<std::size_t>(*recording.channel(channel::load_angle));
    const auto load_torque = static_cast<std::size_t>(*recording.channel(channel::load_torque));
    for (RecordedRun& run : recording.runs) {
        run.pretension_N = rig.pretension_N;
        for (double& angle_rad : run.values[load_angle])
            angle_rad = rig.bench.load_angle_sign * (angle_rad - rig.bench.load_angle_zero_rad);
        for (double& torque_Nm : run.values[load_torque]) torque_Nm *= rig.bench.load_torque_sign;
    }
}

// A rig's recording without any effect, read back, with the nominal numbers also of a drive.
Recording effect_free_recording(const Rig& rig, const std::vector<TrialRun>& runs) {
    const TrialBench& bench = rig.bench;
    TrialStream noise(3, 1, DrawTopic::noise);
    std::vector<SensedRun> logged;
    const SensedSession sensed = sense_session(bench, run_session(bench, runs, {}, rig_simulation(48)), {});
    for (const SensedRun& run : sensed) logged.push_back(with_noise(bench, run, {}, noise));
    const ScratchFolder folder;
    write_recording(folder.path(), "none", bench, runs, logged);
    Recording recording = read_recording(folder.path() / "none.csv");
    if (bench.is_drive()) as_known_bench(rig, recording);
    return recording;
}

// RMS of recorded minus the engine's model, by channel.
std::map<std::string, double> missed_rms(const Recording& recording, const gap::EffectsTwin& twin,
                                         const gap::BenchNumbers& numbers) {
    std::map<std::string, double> missed;
    std::map<std::string, double> samples;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const gap::TwinRun model = twin.run(run, numbers);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            const std::string& name = recording.channels[channel].name;
            for (std::size_t k = 0; k < model.values[channel].size(); ++k) {
                missed[name] +=
                    std::pow(recording.runs[run].values[channel][k] - model.values[channel][k], 2);
                samples[name] += 1.0;
            }
        }
    }
    for (auto& [name, sum] : missed) sum = std::sqrt(sum / samples[name]);
    return missed;
}

// RMS of recorded minus the engine's model over the floor that the trial assumes, by channel.
std::map<std::string, double> missed_in_floors(BenchKind kind, int number) {
    TrialStream draws(4, number, DrawTopic::bench);
    TrialStream motion(4, number, DrawTopic::motion);
    const Rig rig = draw_rig(kind, 0.02, draws);
    const std::vector<TrialRun> runs = draw_rig_session(rig, 2, motion);
    const Recording recording = effect_free_recording(rig, runs);
    const gap::EffectsTwin twin(recording, {100, 1});
    std::map<std::string, double> missed = missed_rms(recording, twin, {});
    for (auto& [name, rms] : missed) rms /= rig.bench.floor.at(name);
    return missed;
}

// Where a driven angle rests within a step of its encoder, the model knows its torque only roughly.
TEST(Rigs, WithoutAnEffectTheEnginesTwinMissesAboutTheStatedFloor) {
    for (const BenchKind kind : {BenchKind::rig_pair, BenchKind::rig_single, BenchKind::rig_drive}) {
        double sum = 0.0;
        double channels = 0.0;
        for (int number = 1; number <= 4; ++number) {
            for (const auto& [channel, missed] : missed_in_floors(kind, number)) {
                EXPECT_LT(missed, 2.5) << bench_kind_name(kind) << " " << number << " " << channel;
                sum += missed;
                channels += 1.0;
            }
        }
        EXPECT_LT(sum / channels, 1.0) << bench_kind_name(kind);
    }
}

// Labels, sidecar and simulation agree: with the label's ratios and friction, and its zeros taken off, the
// engine predicts a rig that has no cause.
void expect_rig_without_cause_is_predicted(BenchKind kind, int number) {
    PlannedCase planned;
    planned.index = number;
    planned.name = "case001";
    planned.bench = kind;
    const TrialOptions options{.seed = 12};
    const ScratchFolder folder;
    const CaseLabel label = make_rig_case(planned, options, folder.path());
    Recording recording = read_recording(folder.path() / "case001.csv");
    CaseStreams draws(options.seed, number);
    const Rig rig = draw_rig(kind, 1.0, draws.bench);
    if (rig.bench.is_drive()) as_known_bench(rig, recording);
    gap::BenchNumbers numbers;
    numbers.friction_ratio = label.friction_ratio;
    numbers.stiffness_ratio = label.stiffness_ratio;
    numbers.pretension_ratio = label.pretension_ratio;
    PulleyFriction& friction = numbers.effects.of<PulleyFriction>();
    friction.motor.presliding_rad = friction.load.presliding_rad = 3e-4;
    for (const Nuisance& nuisance : label.nuisances) {
        if (nuisance.where == "motor") friction.motor.coulomb_Nm = nuisance.size;
        if (nuisance.where == "load") friction.load.coulomb_Nm = nuisance.size;
        if (nuisance.effect != "sensor_offset") continue;
        const double sign =
            rig.bench.is_drive() && nuisance.where == channel::load_torque ? rig.bench.load_torque_sign : 1.0;
        for (RecordedRun& run : recording.runs)
            for (double& value : run.values[static_cast<std::size_t>(*recording.channel(nuisance.where))])
                value -= sign * nuisance.size;
    }
    const gap::EffectsTwin twin(recording, {100, 1});
    for (const auto& [name, missed] : missed_rms(recording, twin, numbers)) {
        const double noise = rig.bench.noise_std.count(name) > 0 ? rig.bench.noise_std.at(name) : 0.0;
        EXPECT_LT(missed, 2.5 * std::hypot(noise, rig.bench.floor.at(name)))
            << bench_kind_name(kind) << " " << number << " " << name;
    }
}

TEST(Rigs, WithTheLabelsNumbersTheEngineExplainsARigWithoutACause) {
    for (int number = 1; number <= 3; ++number) {
        expect_rig_without_cause_is_predicted(BenchKind::rig_pair, number);
        expect_rig_without_cause_is_predicted(BenchKind::rig_single, number);
        expect_rig_without_cause_is_predicted(BenchKind::rig_drive, number);
    }
}

PlannedCase planned_rig(BenchKind bench, int causes) {
    PlannedCase planned;
    planned.index = 1;
    planned.name = "case001";
    planned.group = causes == 0   ? TruthGroup::none
                    : causes == 1 ? TruthGroup::catalogue
                    : causes == 2 ? TruthGroup::mixture
                                  : TruthGroup::three;
    planned.bench = bench;
    planned.causes = causes;
    return planned;
}

TEST(Rigs, ADriveIsRecordedAsALaboratoryWithoutNumbersWould) {
    const ScratchFolder folder;
    const CaseLabel label = make_rig_case(planned_rig(BenchKind::rig_drive, 1), {.seed = 3}, folder.path());
    const Recording recording = read_recording(folder.path() / "case001.csv");
    EXPECT_EQ(recording.mode, BenchMode::lumped_drive);
    EXPECT_FALSE(recording.nominal);
    EXPECT_EQ(recording.runs.front().driven, (std::vector<std::string>{"motor_angle", "load_torque"}));
    EXPECT_EQ(label.causes.size(), 1U);
    EXPECT_EQ(label.bench, "rig_drive");
}

TEST(Rigs, CausesAreDrawnBetweenHalfAndTenTimesNoiseAndFloorTheClearestFirst) {
    const ScratchFolder folder;
    const CaseLabel label = make_rig_case(planned_rig(BenchKind::rig_single, 3), {.seed = 3}, folder.path());
    ASSERT_EQ(label.causes.size(), 3U);
    for (const TrueCause& cause : label.causes) {
        EXPECT_GE(cause.visibility, 0.5 / 1.2);
        EXPECT_LE(cause.visibility, 10.0 * 1.2);
        EXPECT_LE(cause.visibility, label.causes.front().visibility);
        for (const Nuisance& nuisance : label.nuisances)
            EXPECT_TRUE(nuisance.effect != cause.effect) << cause.effect;
    }
    EXPECT_GT(std::abs(std::log(label.friction_ratio)), std::log(1.069));
    EXPECT_LT(std::abs(std::log(label.friction_ratio)), std::log(1.201));
}

TEST(Rigs, AConditionReachesTheSidecarAndANumberFollowsIt) {
    PlannedCase planned = planned_rig(BenchKind::rig_drive, 1);
    planned.has_conditions = planned.varies = true;
    const ScratchFolder folder;
    const CaseLabel label = make_rig_case(planned, {.seed = 5}, folder.path());
    ASSERT_EQ(label.conditions.size(), 1U);
    EXPECT_EQ(label.causes.front().varies, label.conditions.front());
    const std::string sidecar = bytes_of(folder.path() / "case001.json");
    EXPECT_NE(sidecar.find("\"condition\": {"), std::string::npos);
    EXPECT_NE(sidecar.find(label.conditions.front()), std::string::npos);
}

TEST(Nuisances, TheLabelsStateWhatTheRigHas) {
    for (const BenchKind kind : {BenchKind::rig_pair, BenchKind::rig_single, BenchKind::rig_drive}) {
        TrialStream draws(6, 1, DrawTopic::bench);
        const Rig rig = draw_rig(kind, 1.0, draws);
        TrueEffects effects;
        std::size_t zeros = 0;
        for (const Nuisance& nuisance : add_nuisances(rig, effects, draws)) {
            if (nuisance.effect == "sensor_offset") {
                ++zeros;
                EXPECT_DOUBLE_EQ(effects.sensors.at(nuisance.where).offset, nuisance.size);
                EXPECT_NE(nuisance.size, 0.0);
            } else {
                EXPECT_EQ(nuisance.effect, "pulley_friction");
                const TrueBearing& bearing =
                    nuisance.where == "motor" ? effects.motor_bearing : effects.load_bearing;
                EXPECT_DOUBLE_EQ(bearing.coulomb_Nm, nuisance.size);
            }
        }
        EXPECT_EQ(zeros, 2 + rig.bench.tension_sensors.size());
        for (const Nuisance& nuisance : add_wrong_nominals(effects, draws)) {
            const double ratio = nuisance.effect == "param_mu"  ? effects.friction_ratio
                                 : nuisance.effect == "param_K" ? effects.stiffness_ratio
                                                                : effects.pretension_ratio;
            EXPECT_NEAR(std::log(ratio), nuisance.size, 1e-12);
        }
    }
}

// A zero is in the reading and changes nothing else.
TEST(Nuisances, ASensorReadsItsZero) {
    TrialStream draws(6, 1, DrawTopic::bench);
    const Rig rig = draw_rig(BenchKind::rig_drive, 1.0, draws);
    const std::vector<TrialRun> runs = draw_rig_session(rig, 1, draws);
    const std::vector<TrueRun> truth = run_session(rig.bench, runs, {}, rig_simulation(24));
    TrueEffects effects;
    effects.sensors[channel::motor_torque].offset = 0.25;
    const SensedRun without = sense_session(rig.bench, truth, {}).front();
    const SensedRun with = sense_session(rig.bench, truth, effects).front();
    for (std::size_t k = 0; k < with[0].size(); ++k) {
        EXPECT_NEAR(with[0][k] - without[0][k], 0.25, 1e-9);
        EXPECT_EQ(with[2][k], without[2][k]);
    }
}

TEST(Rigs, AConditionedNumberChangesOnlyRunsUnderTheCondition) {
    TrueEffects effects;
    effects.conditioned = {
        {ConditionedNumber::Which::friction, "", "roll_deg", 0.2, 90.0, false},
        {ConditionedNumber::Which::zero, channel::load_torque, "roll_deg", 0.3, 90.0, true}};
    const TrueEffects rolled = effects.under({{"roll_deg", -45.0}});
    EXPECT_DOUBLE_EQ(rolled.friction_ratio, std::exp(-0.1));
    EXPECT_DOUBLE_EQ(rolled.sensors.at(channel::load_torque).offset, 0.075);
    EXPECT_DOUBLE_EQ(effects.under({{"roll_deg", 0.0}}).friction_ratio, 1.0);
    EXPECT_DOUBLE_EQ(effects.under({}).friction_ratio, 1.0);
}

TEST(Rigs, ThePlanDealsCausesKindsAndConditionsInTheirProportions) {
    const std::vector<PlannedCase> plan = plan_rigs({.cases = 120, .seed = 8});
    std::map<int, int> causes;
    std::map<BenchKind, int> kinds;
    int conditions = 0;
    int varying = 0;
    for (const PlannedCase& each : plan) {
        ++causes[each.causes];
        ++kinds[each.bench];
        conditions += each.has_conditions ? 1 : 0;
        varying += each.varies ? 1 : 0;
    }
    EXPECT_EQ(causes[0], 12);
    EXPECT_EQ(causes[1], 42);
    EXPECT_EQ(causes[2], 36);
    EXPECT_EQ(causes[3], 30);
    EXPECT_EQ(kinds[BenchKind::rig_drive], 40);
    EXPECT_EQ(kinds[BenchKind::rig_single], 20);
    EXPECT_EQ(conditions, 48);
    EXPECT_GT(varying, 15);
    EXPECT_LE(varying, 24);
}

}  // namespace
}  // namespace capstan::gap_trial
