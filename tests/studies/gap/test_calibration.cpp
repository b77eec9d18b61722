#include <gtest/gtest.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/calibration.h"
#include "capstan/recording/recording_reader.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

const ParameterEstimate& estimate_of(const Calibration& calibration, const std::string& name) {
    for (const ParameterEstimate& estimate : calibration.parameters) {
        if (estimate.parameter.name == name) return estimate;
    }
    throw std::out_of_range(name);
}

// Truth: 25% more friction, 10% less stiffness, 8% more pretension than the sidecar says.
const std::vector<double> off_nominal = {0.25, 0.5, 3600.0, 1.08};

TEST(Calibration, RecoversTheTrueParameters) {
    const Recording recording = measured_session(off_nominal);
    const Calibration calibration = calibrate(recording, {});
    EXPECT_TRUE(calibration.converged);
    for (const auto& [name, truth, relative] :
         {std::tuple{"dynamic_friction", 0.25, 0.01}, std::tuple{"axial_stiffness", 3600.0, 0.01},
          std::tuple{"pretension", 1.08, 0.01}}) {
        const ParameterEstimate& estimate = estimate_of(calibration, name);
        EXPECT_TRUE(estimate.identifiable) << name;
        EXPECT_NEAR(estimate.value / truth, 1.0, relative) << name;
        EXPECT_LE(estimate.low, truth * 1.002) << name;
        EXPECT_GE(estimate.high, truth * 0.998) << name;
    }
    for (const ChannelFit& fit : calibration.channels) {
        EXPECT_TRUE(fit.held_out);
        EXPECT_LT(fit.held_out_rms, 0.7 * fit.nominal_rms) << fit.channel << " in run " << fit.run;
        if (fit.noise == 0.0) continue;
        EXPECT_NEAR(fit.calibrated_rms / fit.noise, 1.0, 0.15) << fit.channel;
    }
}

// Torque that dies out in the first bends: the motor angle goes as torque squared over (K mu T0), so that
// only the product of the three can be told, and with a coarse encoder not even that.
TEST(Calibration, ReportsParametersThatTheRecordingDoesNotDetermine) {
    Recording recording = driven_session();
    recording.runs.resize(1);
    recording.runs[0].pretension_N = 40.0;
    recording.channels.resize(4);         // no tension sensor, which would tell the pretension
    recording.channels[1].step = 0.0314;  // 200 counts a turn
    recording.tension_sensors.clear();
    recording.runs[0].values.resize(4);
    const auto bench = make_twin(recording);
    const TwinRun truth = bench->run(0, off_nominal);
    for (const std::size_t channel : {1, 3}) recording.runs[0].values[channel] = truth.values[channel];
    const Calibration calibration = calibrate(recording, {});
    int known = 0;
    for (const ParameterEstimate& estimate : calibration.parameters) {
        if (estimate.identifiable) {
            ++known;
            continue;
        }
        EXPECT_EQ(estimate.value, estimate.parameter.nominal);
        EXPECT_FALSE(estimate.reason.empty());
    }
    EXPECT_LT(known, 3);
    EXPECT_FALSE(calibration.channels.front().held_out);
}

TEST(Calibration, IsTheSameForAnyNumberOfThreads) {
    const Recording recording = measured_session(off_nominal);
    const std::vector<double> one = calibrate(recording, {{}, 40, 1}).values();
    EXPECT_EQ(calibrate(recording, {{}, 40, 3}).values(), one);
}

TEST(Calibration, FitsOnlyTheRequestedParameters) {
    const Calibration calibration = calibrate(measured_session(off_nominal), {{"pretension"}, 40, 0});
    EXPECT_EQ(estimate_of(calibration, "dynamic_friction").value, 0.2);
    EXPECT_FALSE(estimate_of(calibration, "dynamic_friction").fitted);
    EXPECT_GT(estimate_of(calibration, "pretension").value, 1.0);
    EXPECT_THROW(calibrate(driven_session(), {{"pretention"}, 40, 0}), InvalidInput);
}

TEST(Twin, MotorAngleAndMotorTorqueDriveTheSameBench) {
    Recording recording = measured_session({0.2, 0.4, 4000.0, 1.0});
    const auto by_torque = make_twin(recording);
    const TwinRun torque_run = by_torque->run(1, nominal_values(*by_torque));
    recording.runs[1].values[1] = torque_run.values[1];
    recording.runs[1].driven = {"motor_angle", "load_angle"};
    recording.channels[1].step.reset();  // nothing to smooth: these angles are exact
    const auto by_angle = make_twin(recording);
    const TwinRun angle_run = by_angle->run(1, nominal_values(*by_angle));
    for (std::size_t sample = 0; sample < torque_run.values[3].size(); ++sample)
        EXPECT_NEAR(angle_run.values[3][sample], torque_run.values[3][sample], 1e-6);
}

TEST(Twin, RejectsABenchDrivenByTwoTorques) {
    Recording recording = measured_session({0.2, 0.4, 4000.0, 1.0});
    recording.runs[0].driven = {"motor_torque", "load_torque"};
    EXPECT_THROW(make_twin(recording), InvalidInput);
}

class OpenRecordings : public testing::Test {
  protected:
    static Recording open(const std::string& path) { return read_recording(std::filesystem::path(path)); }
    static bool there(const std::string& path) { return std::filesystem::exists(path); }
};

// The two without a gap, and the one whose friction is 1.3166 times what its sidecar says.
TEST_F(OpenRecordings, CalibrateToTheirTrueParameters) {
    const std::string folder = CAPSTAN_OPEN_RECORDINGS;
    if (!there(folder)) GTEST_SKIP() << folder << " is not here";
    for (const auto& [file, friction, tolerance] :
         {std::tuple{"/open01.csv", 0.21, 0.001}, std::tuple{"/open13.csv", 0.21 * 1.3166, 0.001}}) {
        const Calibration calibration = calibrate(open(folder + file), {});
        EXPECT_NEAR(estimate_of(calibration, "dynamic_friction").value, friction, tolerance) << file;
        EXPECT_NEAR(estimate_of(calibration, "axial_stiffness").value, 4000.0, 20.0) << file;
        EXPECT_NEAR(estimate_of(calibration, "pretension").value, 1.0, 0.005) << file;
    }
    // Tight bends, two protocols: friction and pretension trade with each other, and it must say so.
    const Calibration tight = calibrate(open(folder + "/open02.csv"), {});
    const ParameterEstimate& friction = estimate_of(tight, "dynamic_friction");
    EXPECT_LE(friction.low, 0.21);
    EXPECT_GE(friction.high, 0.21);
    EXPECT_NE(friction.reason.find("trades with"), std::string::npos);
}

TEST_F(OpenRecordings, HeldOutRunsOfARealGrasperArePredicted) {
    const std::string file = std::string(CAPSTAN_REAL_RECORDINGS) + "/davinci-grip/tool4.csv";
    if (!there(file)) GTEST_SKIP() << file << " is not here";
    const Recording recording = open(file);
    const Calibration calibration = calibrate(recording, {});
    for (const char* name : {"friction_exponent", "stiffness", "pretension", "speed_ratio"})
        EXPECT_TRUE(estimate_of(calibration, name).identifiable) << name;
    for (const ChannelFit& fit : calibration.channels) {
        // Torque loops are 0.1 to 0.24 N m high, jaw angles span 0.9 rad.
        EXPECT_LT(fit.held_out_rms, fit.channel == "motor_torque" ? 0.025 : 0.015) << "run " << fit.run;
    }
}

}  // namespace
}  // namespace capstan::gap
