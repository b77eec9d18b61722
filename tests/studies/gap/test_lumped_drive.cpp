#include <gtest/gtest.h>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/twin.h"
#include "lumped_session.h"

namespace capstan::gap {
namespace {

std::vector<double> true_values(const LumpedTruth& truth) {
    return {truth.friction_exponent, truth.stiffness_Nm_per_rad, truth.pretension_Nm, truth.speed_ratio};
}

TEST(DriveOrientation, ReadsTheRatioOffTheMotion) {
    EXPECT_NEAR(drive_orientation(lumped_session({})).load_per_motor_angle, 0.5, 0.05);
}

TEST(DriveOrientation, FrictionDecidesTheSignOfTheMotorTorque) {
    EXPECT_EQ(drive_orientation(lumped_session({})).motor_torque_sign, 1.0);
    EXPECT_EQ(drive_orientation(lumped_session({.motor_torque_sign = -1.0})).motor_torque_sign, -1.0);
}

TEST(DriveOrientation, ALoadThatTheMotorCarriesAddsToItsTorque) {
    EXPECT_EQ(drive_orientation(lumped_session({})).load_torque_sign, 1.0);
    EXPECT_EQ(drive_orientation(lumped_session({.motor_torque_sign = -1.0})).load_torque_sign, 1.0);
}

// More friction from run to run raises the mean torque of the motor and lowers that of the spring.
TEST(DriveOrientation, ASpringAtTheLoadAddsToTheTorqueOfTheMotorWhateverTheRunsDifferIn) {
    Recording drive = lumped_session({.friction_exponent = 0.2, .load_spring_Nm_per_rad = 3.0});
    const Recording bent = lumped_session({.friction_exponent = 0.6, .load_spring_Nm_per_rad = 3.0});
    drive.runs.back() = bent.runs.back();
    for (double& torque_Nm : drive.runs.front().values[3]) torque_Nm += 0.02;
    for (double& torque_Nm : drive.runs.back().values[0]) torque_Nm += 0.02;
    EXPECT_EQ(drive_orientation(drive).load_torque_sign, 1.0);
    for (RecordedRun& run : drive.runs)
        for (double& torque_Nm : run.values[3]) torque_Nm *= -1.0;
    EXPECT_EQ(drive_orientation(drive).load_torque_sign, -1.0);
}

TEST(DriveOrientation, RejectsADriveThatDoesNotMove) {
    Recording still = lumped_session({});
    for (RecordedRun& run : still.runs) run.values[1].assign(run.time_s.size(), 0.0);
    EXPECT_THROW(drive_orientation(still), InvalidInput);
}

TEST(DriveOrientation, OfAChannelThatWasNotRecordedTheRatioIsOne) {
    Recording without_load_angle = lumped_session({.motor_torque_sign = -1.0});
    without_load_angle.channels[2].name = "jaw_angle";
    const DriveOrientation orientation = drive_orientation(without_load_angle);
    EXPECT_EQ(orientation.load_per_motor_angle, 1.0);
    EXPECT_EQ(orientation.motor_torque_sign, -1.0);
}

TEST(LumpedDrive, IsNotCalibratedWithoutAllFourChannels) {
    Recording without_load_angle = lumped_session({});
    without_load_angle.channels[2].name = "jaw_angle";
    EXPECT_THROW(make_twin(without_load_angle), InvalidInput);
}

TEST(LumpedDrive, WithTheTrueNumbersPredictsTorqueAndAngle) {
    for (const double sign : {1.0, -1.0}) {
        const LumpedTruth truth{.motor_torque_sign = sign};
        const Recording recording = lumped_session(truth);
        const auto twin = make_twin(recording);
        const TwinRun predicted = twin->run(1, true_values(truth));
        EXPECT_EQ(predicted.unsolved_steps, 0);
        for (std::size_t sample = 0; sample < predicted.values[0].size(); ++sample) {
            EXPECT_NEAR(predicted.values[0][sample], recording.runs[1].values[0][sample], 1e-9);
            EXPECT_NEAR(predicted.values[2][sample], recording.runs[1].values[2][sample], 1e-9);
        }
    }
}

TEST(LumpedDrive, StartsNearWhatTheFrictionLoopShows) {
    const auto twin = make_twin(lumped_session({}));
    const std::vector<double> start = nominal_values(*twin);
    const std::vector<double> truth = true_values({});
    for (std::size_t k = 0; k < truth.size(); ++k) {
        EXPECT_GT(start[k], truth[k] / 10.0) << twin->parameters()[k].name;
        EXPECT_LT(start[k], truth[k] * 10.0) << twin->parameters()[k].name;
    }
}

}  // namespace
}  // namespace capstan::gap
