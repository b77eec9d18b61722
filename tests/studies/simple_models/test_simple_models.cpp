#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "capstan/recording/recording_reader.h"
#include "capstan/simple_models/simple_models.h"
#include "capstan/simple_models/stop_operator.h"
#include "rough_drive.h"

namespace capstan::simple_models {
namespace {

constexpr std::size_t torque = 2;

const SimpleModel& named(const std::vector<SimpleModel>& models, const std::string& name) {
    for (const SimpleModel& model : models)
        if (model.name == name) return model;
    throw std::out_of_range(name);
}

double held_out_rms(const SimpleModel& model, const Recording& recording) {
    double squares = 0.0;
    double samples = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const auto scored = static_cast<double>(run.time_s.size() - first_scored_sample(run));
        squares += scored * std::pow(scored_rms(run, model.channels.output, model.predict(run)), 2);
        samples += scored;
    }
    return std::sqrt(squares / samples);
}

TEST(StopOperator, FollowsTheMotionUpToItsLimitAndTurnsWithinTwiceThat) {
    const std::vector<double> motion = {1.0, 1.1, 1.5, 1.4, 1.2};
    const Eigen::VectorXd held = stop_operator(motion, 0.2);
    const std::vector<double> expected = {0.0, 0.5, 1.0, 0.5, -0.5};
    for (std::size_t sample = 0; sample < motion.size(); ++sample)
        EXPECT_NEAR(held[static_cast<Eigen::Index>(sample)], expected[sample], 1e-12);
}

TEST(SimpleModels, RecoverADriveOfTheirOwnFormOnRunsHeldOut) {
    // The friction builds up within a path that is one of the thresholds: 0.04 of the motion's range.
    RoughDrive drive;
    const Recording all = session_of(drive, 6);
    const auto [low, high] =
        std::minmax_element(all.runs.front().values[0].begin(), all.runs.front().values[0].end());
    drive.built_up_rad = 2.0 * 0.04 * (*high - *low);
    const Recording session = session_of(drive, 6);
    const Recording held = with_numbers(session, 0);
    const std::vector<SimpleModel> models = fit_simple_models(with_numbers(session, 1), torque);
    ASSERT_EQ(models.size(), 5u);
    // The load is negative, so the script's signed product of load and stop operator is exact. The ridge
    // leaves about a thousandth.
    EXPECT_LT(held_out_rms(named(models, "closed_form"), held), 2e-4);
    EXPECT_LT(held_out_rms(named(models, "prandtl_ishlinskii"), held), 5e-4);
    // Without a memory of reversals most of the friction is left: about half of 80 mN m.
    EXPECT_GT(held_out_rms(named(models, "linear"), held), 0.02);
    EXPECT_GT(held_out_rms(named(models, "constant"), held), held_out_rms(named(models, "linear"), held));
}

TEST(SimpleModels, ElasticPlasticElementsRecoverAYieldThatGrowsWithTheLoadOnRunsHeldOut) {
    const Recording session = session_of({.stiffness_Nm_per_rad = 1.2}, 6);
    const Recording held = with_numbers(session, 0);
    const std::vector<SimpleModel> models = fit_simple_models(with_numbers(session, 1), torque);
    EXPECT_LT(held_out_rms(named(models, "elastic_plastic"), held), 2e-4);
    // The path in which the friction builds up varies with the load, which no linear model has.
    EXPECT_GT(held_out_rms(named(models, "closed_form"), held), 1e-3);
}

TEST(SimpleModels, ScaleWithTheUnitOfTheirOutput) {
    RoughDrive drive;
    const std::vector<SimpleModel> in_Nm = fit_simple_models(session_of(drive, 3), torque);
    drive.sensor_gain = 1000.0;
    const std::vector<SimpleModel> in_mNm = fit_simple_models(session_of(drive, 3), torque);
    for (std::size_t k = 0; k < in_Nm.size(); ++k)
        EXPECT_NEAR(in_mNm[k].fitted_rms, 1000.0 * in_Nm[k].fitted_rms, 1e-3 * in_mNm[k].fitted_rms)
            << in_Nm[k].name;
}

TEST(SimpleModels, AreFittedFromOneSecondIntoEachRun) {
    const Recording session = session_of({}, 2);
    Recording spoiled = session;
    for (RecordedRun& run : spoiled.runs)
        for (std::size_t sample = 0; sample < 100; ++sample) run.values[torque][sample] += 5.0;
    const std::vector<SimpleModel> expected = fit_simple_models(session, torque);
    const std::vector<SimpleModel> found = fit_simple_models(spoiled, torque);
    for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_EQ(found[k].fitted_rms, expected[k].fitted_rms) << expected[k].name;
}

TEST(SimpleModels, LeaveTheLoadOutWhereNoneIsRecorded) {
    Recording session = session_of({.yield_per_load = 0.0}, 2, 0.0);
    session.mode = BenchMode::capstan_band;
    session.channels = {
        {"displacement", "m", {}, {}}, {"velocity", "m/s", {}, {}}, {"tension_1", "N", {}, {}}};
    for (RecordedRun& run : session.runs) run.driven = {"displacement"};
    EXPECT_EQ(output_channels(session), std::vector<std::size_t>{2});
    const std::vector<ModelledOutput> choices = possible_inputs(session, 2);
    ASSERT_EQ(choices.size(), 1u);
    EXPECT_FALSE(choices.front().load.has_value());
    const std::vector<SimpleModel> models = fit_simple_models(session, 2);
    EXPECT_LT(named(models, "elastic_plastic").fitted_rms, 1e-3);
    EXPECT_EQ(named(models, "elastic_plastic").numbers, 14u);
}

TEST(SimpleModels, TakeTheMotionThatFitsBestWhereAnyChannelMayBeIt) {
    // A bench of known geometry whose friction follows the second driven channel.
    Recording session = session_of({}, 2);
    session.mode = BenchMode::pull_pull;
    session.nominal = NominalBench{};
    std::swap(session.channels[0], session.channels[1]);
    for (RecordedRun& run : session.runs) std::swap(run.values[0], run.values[1]);
    ASSERT_EQ(possible_inputs(session, torque).size(), 2u);
    EXPECT_EQ(named(fit_simple_models(session, torque), "elastic_plastic").channels.motion, 1u);
}

TEST(SimpleModels, AreNoneWhereNothingIsDrivenOrNothingIsLongEnough) {
    Recording session = session_of({}, 2);
    for (RecordedRun& run : session.runs) run.driven.clear();
    EXPECT_TRUE(fit_simple_models(session, torque).empty());
    session = session_of({}, 1);
    session.runs.front().time_s.resize(50);
    for (std::vector<double>& values : session.runs.front().values) values.resize(50);
    EXPECT_TRUE(fit_simple_models(session, torque).empty());
}

// What shared/tools/real_baselines.py prints for the odd runs and the even ones, motor torque [N m]. The
// elastic-plastic elements are fitted by another search there.
struct RealDrive {
    const char* file;
    double linear, closed_form, prandtl_ishlinskii, elastic_plastic;
};

class RealDrives : public testing::TestWithParam<RealDrive> {};

TEST_P(RealDrives, AreMetAsByTheReferenceScript) {
    const std::filesystem::path file =
        std::filesystem::path(CAPSTAN_REAL_RECORDINGS) / "davinci-grip" / GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not part of this repository";
    const Recording session = read_recording(file);
    const Recording held = with_numbers(session, 0);
    const auto output = static_cast<std::size_t>(*session.channel("motor_torque"));
    const std::vector<SimpleModel> models = fit_simple_models(with_numbers(session, 1), output);
    EXPECT_NEAR(held_out_rms(named(models, "linear"), held), GetParam().linear, 5e-4 * GetParam().linear);
    EXPECT_NEAR(held_out_rms(named(models, "closed_form"), held), GetParam().closed_form,
                5e-4 * GetParam().closed_form);
    EXPECT_NEAR(held_out_rms(named(models, "prandtl_ishlinskii"), held), GetParam().prandtl_ishlinskii,
                5e-4 * GetParam().prandtl_ishlinskii);
    EXPECT_NEAR(held_out_rms(named(models, "elastic_plastic"), held), GetParam().elastic_plastic,
                0.05 * GetParam().elastic_plastic);
}

INSTANTIATE_TEST_SUITE_P(Graspers, RealDrives,
                         testing::Values(RealDrive{"tool4_more.csv", 0.062346, 0.012494, 0.0075404,
                                                   0.0069624},
                                         RealDrive{"right_jaw.csv", 0.039773, 0.0079729, 0.0047887, 0.00497}),
                         [](const auto& drive) {
                             const std::string file = drive.param.file;
                             return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace capstan::simple_models
