#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "capstan/effects/effect_catalogue.h"
#include "capstan/gap/cause_search.h"
#include "capstan/gap/diagnosis.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/recording/recording_reader.h"
#include "lumped_session.h"
#include "nearly_certain.h"
#include "sample_recording.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

// What is driven, as a bench with these numbers measures it, its sensors' noise on it. The bench has twice
// the segments of the model that is to explain it, and steps at every sample.
Recording measured(Recording recording, const BenchNumbers& numbers) {
    std::mt19937_64 random(20260202);
    std::normal_distribution<double> normal;
    const EffectsTwin bench(recording, {80, 1});
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const TwinRun truth = bench.run(run, numbers);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (truth.values[channel].empty()) continue;
            recording.runs[run].values[channel] = truth.values[channel];
            const double noise = sample_noise(recording.channels[channel]);
            for (double& value : recording.runs[run].values[channel]) value += noise * normal(random);
        }
    }
    return recording;
}

Recording session_of(const BenchNumbers& numbers, const std::vector<double>& rolls_deg = {}) {
    Recording recording = driven_session();
    for (std::size_t run = 0; run < rolls_deg.size(); ++run)
        recording.runs.at(run).conditions["roll_deg"] = rolls_deg[run];
    return measured(recording, numbers);
}

// With the second run once more: the first is too slow to show a drag, so that a run that is left out has
// another that does.
Recording long_session_of(const BenchNumbers& numbers) {
    Recording recording = driven_session();
    recording.runs.push_back(recording.runs.back());
    recording.runs.back().number = 3;
    recording.runs.back().session_start_s += 7.0;
    return measured(recording, numbers);
}

Diagnosis diagnosed(const Recording& recording) {
    DiagnosisOptions options;
    options.segments = 30;
    options.stride = 1;
    return diagnose(recording, options);
}

const ChannelGap& channel_of(const Diagnosis& diagnosis, const std::string& name) {
    for (const ChannelGap& channel : diagnosis.gap.channels) {
        if (channel.channel == name) return channel;
    }
    throw std::out_of_range(name);
}

TEST(Diagnosis, ReportsNoneWhereTheBenchIsItsModel) {
    const Diagnosis diagnosis = diagnosed(session_of({}));
    EXPECT_EQ(diagnosis.ranked.front().effect, "none");
    EXPECT_TRUE(diagnosis.causes.empty());
    EXPECT_LT(diagnosis.misfit_after, 1.1);  // noise, and none of the floor that is allowed
}

TEST(Diagnosis, ProbabilitiesSumToOne) {
    double sum = 0.0;
    const Diagnosis diagnosis = diagnosed(session_of({}));
    for (const RankedEffect& each : diagnosis.ranked) sum += each.probability;
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Diagnosis, FindsViscousFrictionAndItsSize) {
    BenchNumbers numbers;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 4.0;
    const Diagnosis diagnosis = diagnosed(long_session_of(numbers));
    EXPECT_EQ(diagnosis.ranked.front().effect, "viscous_friction");
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, 4.0, 0.4);
    EXPECT_EQ(diagnosis.component, "conduit");
    const ChannelGap& torque = channel_of(diagnosis, "load_torque");
    EXPECT_LT(torque.after_rms, 0.25 * torque.before_rms);
    EXPECT_LT(torque.held_out_rms, 0.15 * torque.before_rms);
}

TEST(Diagnosis, NamesFrictionThatFollowsAConditionOfTheRuns) {
    BenchNumbers numbers;
    numbers.follows = {{.condition = "roll_deg", .half_range = 45.0, .linear = 0.3}};
    const Diagnosis diagnosis = diagnosed(session_of(numbers, {-45.0, 45.0}));
    EXPECT_EQ(diagnosis.ranked.front().effect, "param_mu");
    EXPECT_EQ(diagnosis.ranked.front().varies, "roll_deg");
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, 0.3, 0.05);
}

BenchNumbers tensioned_anew_in_run_2(double change) {
    BenchNumbers numbers;
    numbers.follows = {
        {.what = BenchNumbers::Following::What::pretension, .of_runs = {{1, 0.0}, {2, change}}}};
    return numbers;
}

TEST(Diagnosis, NamesPretensionThatDiffersBetweenRunsAsNobodyStated) {
    const Diagnosis diagnosis = diagnosed(session_of(tensioned_anew_in_run_2(-0.3)));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "param_T0");
    EXPECT_EQ(diagnosis.causes.front().variant, "between runs");
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, -0.3, 0.03);
    EXPECT_EQ(diagnosis.ranked.front().varies, "");
}

TEST(BenchNumbers, ANumberThatDiffersBetweenRunsIsTheirMeanInAnyOther) {
    const BenchNumbers numbers = tensioned_anew_in_run_2(-0.4);
    const auto pretension_in = [](const BenchNumbers& its, int number) {
        RecordedRun run;
        run.number = number;
        return std::log(its.in_run(run).pretension_ratio);
    };
    EXPECT_DOUBLE_EQ(pretension_in(numbers, 1), 0.0);
    EXPECT_DOUBLE_EQ(pretension_in(numbers, 2), -0.4);
    EXPECT_DOUBLE_EQ(pretension_in(numbers, 3), -0.2);
    EXPECT_DOUBLE_EQ(pretension_in(numbers.in_other_runs(), 2), -0.2);
}

// A joint that bends either way from straight: the same at both ends of the range.
TEST(BenchNumbers, ANumberMayFollowTheSquareOfACondition) {
    BenchNumbers numbers;
    numbers.follows = {
        {.condition = "roll_deg", .middle = 10.0, .half_range = 40.0, .linear = 0.1, .squared = 0.2}};
    const auto friction_at = [&](double roll_deg) {
        RecordedRun run;
        run.conditions["roll_deg"] = roll_deg;
        return std::log(numbers.in_run(run).friction_ratio);
    };
    EXPECT_NEAR(friction_at(10.0), 0.0, 1e-12);
    EXPECT_NEAR(friction_at(50.0), 0.3, 1e-12);
    EXPECT_NEAR(friction_at(-30.0), 0.1, 1e-12);
    EXPECT_NEAR(std::log(numbers.in_run({}).friction_ratio), 0.0, 1e-12) << "a run without the condition";
}

// A search may ask for it: friction that follows a condition has no bound of its own.
TEST(EffectsTwin, StandsFrictionThatNoBenchHas) {
    const Recording recording = session_of({}, {-45.0, 45.0});
    const EffectsTwin twin(recording, {30, 1});
    BenchNumbers numbers;
    numbers.follows = {{.condition = "roll_deg", .half_range = 45.0, .linear = 30.0}};
    for (const std::size_t run : {0, 1}) {
        for (const std::vector<double>& channel : twin.run(run, numbers).values) {
            for (const double value : channel) ASSERT_TRUE(std::isfinite(value));
        }
    }
}

TEST(Diagnosis, AConditionThatChangesNothingIsNotNamed) {
    const Diagnosis diagnosis = diagnosed(session_of({}, {-45.0, 45.0}));
    EXPECT_EQ(diagnosis.ranked.front().effect, "none");
}

double present(const Diagnosis& diagnosis, const std::string& effect) {
    for (const RankedEffect& each : diagnosis.ranked) {
        if (each.effect == effect) return each.present;
    }
    return 0.0;
}

// A bench as it is built: its numbers are rough, a sensor has a zero, the bearings rub.
TEST(Diagnosis, FindsACauseBesideRoughNumbersZerosAndBearings) {
    BenchNumbers numbers;
    numbers.friction_ratio = 1.12;
    numbers.stiffness_ratio = 0.92;
    numbers.pretension_ratio = 0.9;
    numbers.sensor_faults["load_torque"].offset = 0.03;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 6.0;
    Recording session = driven_session();
    session.tension_sensors.front().position_m = 1.8;
    const Diagnosis diagnosis = diagnosed(measured(session, numbers));
    EXPECT_EQ(diagnosis.ranked.front().effect, "viscous_friction");
    // Viscous bearings at both ends together do nearly the same to both pulleys. A tension near the load
    // tells them from a drag along the cable.
    EXPECT_GT(present(diagnosis, "viscous_friction"), std::exp(3.0) * present(diagnosis, "pulley_friction"));
    EXPECT_GT(diagnosis.ranked.front().present, 0.99 * (1.0 - mistaken_cause_fraction));
    ASSERT_FALSE(diagnosis.bench.empty());
    const auto zero =
        std::find_if(diagnosis.bench.begin(), diagnosis.bench.end(),
                     [](const FittedNumber& number) { return number.name == "zero of load_torque"; });
    ASSERT_NE(zero, diagnosis.bench.end());
    EXPECT_NEAR(zero->value, 0.03, 0.015);
}

// Class, mounting and calibration leave a gain of some percent on any bench as built.
TEST(Diagnosis, NamesAGainOnABenchAsBuiltOnlyBeyondWhatIsUsual) {
    BenchNumbers numbers;
    numbers.friction_ratio = 1.12;
    numbers.stiffness_ratio = 0.92;
    numbers.pretension_ratio = 0.9;
    const auto present_with_gain = [&](double gain) {
        numbers.sensor_faults["load_torque"].gain = gain;
        return present(diagnosed(session_of(numbers)), "sensor_gain");
    };
    EXPECT_LT(present_with_gain(1.03), 0.3);
    EXPECT_GT(present_with_gain(1.2), 0.8);
}

// A part of a sample is usual of a force, and explains a part of the gap where it shows.
TEST(Diagnosis, NamesADelayOfAForceOnABenchAsBuiltWhereItShows) {
    BenchNumbers numbers;
    numbers.friction_ratio = 1.12;
    numbers.stiffness_ratio = 0.92;
    numbers.pretension_ratio = 0.9;
    numbers.sensor_faults["motor_angle"].offset = 0.01;
    numbers.sensor_faults["load_torque"].offset = 0.03;
    const auto present_with_delay = [&](double samples) {
        numbers.sensor_faults["load_torque"].delay_s = samples / session_of({}).sample_rate_Hz;
        return present(diagnosed(session_of(numbers)), "time_misalignment");
    };
    EXPECT_LT(present_with_delay(0.1), 0.1);
    EXPECT_GT(present_with_delay(0.8), 0.8);
}

// Several stages of a filter look slow and late at once.
TEST(Diagnosis, ASensorThatIsSlowAndLateHasOneFault) {
    BenchNumbers numbers;
    numbers.sensor_faults["load_torque"].lag_s = 0.03;
    numbers.sensor_faults["load_torque"].delay_s = 0.03;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    EXPECT_GT(present(diagnosis, "sensor_lag") + present(diagnosis, "time_misalignment"), nearly_certain);
    EXPECT_LT(std::min(present(diagnosis, "sensor_lag"), present(diagnosis, "time_misalignment")), 0.3);
}

// Neither explains much alone.
TEST(Diagnosis, NamesTheGainOfASensorBesideASoftHand) {
    BenchNumbers numbers;
    numbers.sensor_faults["load_torque"].gain = 1.2;
    numbers.effects.of<EnvironmentCoupling>() = {.compliance_rad_per_Nm = 3e-3, .damping_Nm_s_per_rad = 2.0};
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    EXPECT_GT(present(diagnosis, "sensor_gain"), 0.8);
    EXPECT_GT(present(diagnosis, "environment_coupling"), 0.8);
    EXPECT_EQ(diagnosis.causes.size(), 2u);
}

// A motor that is driven by its torque turns on late by this or by friction of its pulley.
TEST(Diagnosis, TellsAHysteresisOfTheMotorsAngleFromFrictionOfItsPulley) {
    BenchNumbers hysteresis;
    hysteresis.sensor_faults["motor_angle"].hysteresis = 3e-3;
    EXPECT_EQ(diagnosed(session_of(hysteresis)).ranked.front().effect, "sensor_hysteresis");
    BenchNumbers friction;
    friction.effects.of<PulleyFriction>().motor.coulomb_Nm = 0.01;
    EXPECT_EQ(diagnosed(session_of(friction)).ranked.front().effect, "pulley_friction");
}

TEST(Diagnosis, NamesAPretensionThatSettlesDuringTheSession) {
    BenchNumbers numbers;
    numbers.effects.of<PretensionDrift>() = {.lost_by_100_s = 0.5, .settling_s = 10.0};
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "pretension_drift");
}

TEST(Diagnosis, NamesAZeroThatDrifts) {
    BenchNumbers numbers;
    numbers.sensor_faults["load_torque"].drift_by_100_s = 2.0;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "sensor_offset");
    EXPECT_EQ(diagnosis.causes.front().variant, "load_torque drift");
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, 2.0, 0.2);
}

TEST(Diagnosis, NamesTheFrictionOfAGearAsFrictionAtTheMotor) {
    BenchNumbers numbers;
    numbers.effects.of<PulleyFriction>().motor.per_torque = 0.15;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "pulley_friction");
    EXPECT_EQ(diagnosis.causes.front().variant, "motor gear");
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, 0.15, 0.03);
}

TEST(Diagnosis, NamesFrictionThatDiffersByDirection) {
    BenchNumbers numbers;
    numbers.effects.of<DirectionalFriction>().difference = -0.25;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "directional_friction");
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, -0.25, 0.03);
}

TEST(Diagnosis, NamesFrictionThatSettlesDuringTheSession) {
    BenchNumbers numbers;
    numbers.effects.of<FrictionDrift>() = {.change = 0.8, .settling_s = 5.0};
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "friction_drift");
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, 0.8, 0.1);
}

TEST(Diagnosis, NamesAClippedSensorAndItsLimit) {
    Recording recording = session_of({});
    const auto torque = static_cast<std::size_t>(*recording.channel("load_torque"));
    double largest_Nm = 0.0;
    for (const RecordedRun& run : recording.runs)
        for (const double value : run.values[torque]) largest_Nm = std::max(largest_Nm, std::abs(value));
    BenchNumbers numbers;
    numbers.sensor_faults["load_torque"].limit = 0.7 * largest_Nm;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 1u);
    EXPECT_EQ(diagnosis.causes.front().effect, "sensor_clipping");
    EXPECT_EQ(diagnosis.component, "sensor:load_torque");
    EXPECT_NEAR(diagnosis.causes.front().numbers.front().value, 0.7 * largest_Nm, 0.05 * largest_Nm);
}

BenchNumbers rough_numbers() {
    BenchNumbers numbers;
    numbers.friction_ratio = 1.35;
    numbers.stiffness_ratio = 0.85;
    numbers.pretension_ratio = 0.8;
    numbers.sensor_faults["load_torque"].offset = 0.05;
    numbers.effects.of<PulleyFriction>().motor.coulomb_Nm = 0.004;
    return numbers;
}

// A cause that is too faint to show beside them is as probable as none.
TEST(Diagnosis, SeesNothingBesideRoughNumbers) {
    const Diagnosis diagnosis = diagnosed(session_of(rough_numbers()));
    ASSERT_FALSE(diagnosis.bench.empty());
    EXPECT_GT(present(diagnosis, "none"), 0.44);
    EXPECT_LE(present(diagnosis, "none"), 0.5);
    const std::set<std::string> of_the_bench = {"param_mu",      "param_K",         "param_T0",
                                                "sensor_offset", "pulley_friction", "time_misalignment"};
    const auto first =
        std::find_if(diagnosis.ranked.begin(), diagnosis.ranked.end(),
                     [&](const RankedEffect& each) { return of_the_bench.count(each.effect) == 0; });
    EXPECT_EQ(first->effect, "none");
}

// Rough numbers of all kinds could stand for the bearing.
TEST(Diagnosis, FrictionOfABearingBesideAnotherCauseMakesNoMeasuredNumberWrong) {
    BenchNumbers numbers;
    numbers.effects.of<PulleyFriction>().load.coulomb_Nm = 0.1;
    numbers.effects.of<Presliding>().length_m = 3e-4;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    ASSERT_EQ(diagnosis.causes.size(), 2u);
    for (const FittedCause& cause : diagnosis.causes)
        EXPECT_TRUE(cause.effect == "pulley_friction" || cause.effect == "presliding") << cause.effect;
    for (std::size_t k = 0; k < 2; ++k) EXPECT_GT(diagnosis.ranked[k].probability, 0.4);
    EXPECT_TRUE(diagnosis.bench.empty());  // nothing of it floats beyond what was measured
}

// Nobody stated the stiffness or the pretension, and the friction only as a range.
TEST(Diagnosis, FindsACauseOnABenchOfWhichLittleIsStated) {
    BenchNumbers numbers;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 6.0;
    Recording recording = session_of(numbers);
    recording.nominal->axial_stiffness_N *= 3.0;
    recording.nominal->spread = {.friction = 0.3, .stiffness = 1.7, .pretension = 1.7};
    for (RecordedRun& run : recording.runs) run.pretension_N = 0.4 * *run.pretension_N;
    const Diagnosis diagnosis = diagnosed(recording);
    EXPECT_EQ(diagnosis.ranked.front().effect, "viscous_friction");
    EXPECT_NEAR(diagnosis.stiffness_ratio * 3.0, 1.0, 0.1);
    EXPECT_NEAR(diagnosis.pretension_ratio * 0.4, 1.0, 0.1);
    for (const RankedEffect& each : diagnosis.ranked)
        EXPECT_TRUE(each.effect != "param_K" && each.effect != "param_T0")
            << "what nobody stated cannot be wrong";
}

// The calibration of such a drive takes friction that builds up for elasticity and pretension, so that a
// search from its numbers alone ends far off.
TEST(Diagnosis, NamesPreslidingOfADriveWhoseCalibratedPretensionIsFarOff) {
    const Recording ideal = lumped_session({});
    Recording drive = equivalent_bench(ideal, ideal);
    for (Channel& channel : drive.channels) channel.noise_std = channel.unit == "rad" ? 5e-4 : 2e-3;
    BenchNumbers numbers;
    numbers.pretension_ratio = 0.2;
    numbers.effects.of<Presliding>().length_m = 3e-3;
    numbers.effects.of<PulleyFriction>().motor.coulomb_Nm = 0.2;
    numbers.effects.of<PulleyFriction>().motor.presliding_rad = 2e-3;
    std::mt19937_64 random(20261125);
    std::normal_distribution<double> normal;
    const EffectsTwin bench(drive, {.segments = 40, .stride = 1});
    for (std::size_t run = 0; run < drive.runs.size(); ++run) {
        const TwinRun truth = bench.run(run, numbers);
        for (std::size_t channel = 0; channel < drive.channels.size(); ++channel) {
            if (truth.values[channel].empty()) continue;
            drive.runs[run].values[channel] = truth.values[channel];
            for (double& value : drive.runs[run].values[channel])
                value += *drive.channels[channel].noise_std * normal(random);
        }
    }
    const Diagnosis diagnosis = diagnosed(drive);
    EXPECT_EQ(diagnosis.ranked.front().effect, "presliding");
    EXPECT_LT(diagnosis.misfit_after, 1.0);
}

TEST(Diagnosis, LocatesABend) {
    BenchNumbers numbers;
    numbers.effects.of<LocalBend>() = {.extra_angle_rad = 1.0, .middle_m = 1.2, .length_m = 0.2};
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    EXPECT_EQ(diagnosis.ranked.front().effect, "local_bend");
    ASSERT_TRUE(diagnosis.position_m.has_value());
    EXPECT_NEAR(*diagnosis.position_m, 1.2, 0.25);
}

TEST(Diagnosis, NamesTheChannelOfAFaultySensor) {
    BenchNumbers numbers;
    numbers.sensor_faults["load_torque"].lag_s = 0.06;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    EXPECT_EQ(diagnosis.ranked.front().effect, "sensor_lag");
    EXPECT_EQ(diagnosis.component, "sensor:load_torque");
    EXPECT_EQ(diagnosis.gap.worst_channel, "load_torque");
}

TEST(Diagnosis, DistinguishesAWrongFrictionCoefficientFromAMissingEffect) {
    BenchNumbers numbers;
    numbers.friction_ratio = 1.35;
    const Diagnosis diagnosis = diagnosed(session_of(numbers));
    EXPECT_EQ(diagnosis.ranked.front().effect, "param_mu");
    EXPECT_NEAR(diagnosis.friction_ratio, 1.35, 0.05);
}

// A wrong stiffness alone leaves next to nothing, but one bench in a hundred has it so far off.
TEST(Diagnosis, AWrongNumberThatExplainsAllIsNotNoGap) {
    BenchNumbers numbers;
    numbers.stiffness_ratio = 1.08;
    const Diagnosis diagnosis = diagnosed(exact_session(numbers, {.segments = 30, .stride = 1}));
    const CandidateScore none = *std::find_if(
        diagnosis.candidates.begin(), diagnosis.candidates.end(),
        [](const CandidateScore& each) { return each.effects == std::vector<std::string>{"none"}; });
    EXPECT_LT(none.misfit, 0.25);
    EXPECT_GT(none.nominal_penalty, tenable_nominal_penalty);
    EXPECT_EQ(diagnosis.ranked.front().effect, "param_K");
    EXPECT_NEAR(diagnosis.stiffness_ratio, 1.08, 0.01);
}

TEST(Diagnosis, RejectsABenchOfUnknownGeometry) {
    Recording recording = driven_session();
    recording.mode = BenchMode::lumped_drive;
    EXPECT_THROW(diagnosed(recording), std::runtime_error);
}

}  // namespace
}  // namespace capstan::gap
