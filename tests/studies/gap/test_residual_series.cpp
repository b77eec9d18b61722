#include <gtest/gtest.h>

#include <cmath>

#include "capstan/gap/cause_fit.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"

namespace capstan::gap {
namespace {

// A drive of which the motor turns, rests for a second and turns on, and an encoder with this step.
Recording resting_drive(double step_rad) {
    Recording recording = equivalent_bench(lumped_session({}), lumped_session({}));
    for (Channel& channel : recording.channels) {
        if (channel.name == "motor_angle") channel.step = step_rad;
        if (channel.unit == "N m") channel.noise_std = 1e-4;
    }
    for (RecordedRun& run : recording.runs) {
        for (std::size_t sample = 0; sample < run.time_s.size(); ++sample) {
            const double time_s = run.time_s[sample];
            const double turned_rad = 0.6 * std::min(time_s, 1.5) + 0.6 * std::max(0.0, time_s - 2.5);
            run.values[static_cast<std::size_t>(*recording.channel("motor_angle"))][sample] =
                step_rad * std::round(turned_rad / step_rad);
        }
    }
    return recording;
}

const ResidualSeries& series_of(const std::vector<ResidualSeries>& all, const Recording& recording,
                                const std::string& channel) {
    for (const ResidualSeries& each : all) {
        if (recording.channels[each.channel].name == channel) return each;
    }
    throw std::out_of_range(channel);
}

TEST(ResidualSeries, AMotorAtRestWithinAStepOfItsEncoderDoesNotDetermineTheTorque) {
    const Recording recording = resting_drive(2e-3);
    const CauseFitter fitter(recording, {24, 1}, 1);
    const ResidualSeries& torque = series_of(fitter.series(), recording, "motor_torque");
    const RecordedRun& run = recording.runs[torque.run];
    for (std::size_t row = 0; row < torque.rows; ++row) {
        const double time_s = run.time_s[static_cast<std::size_t>(torque.first_sample) + row];
        if (time_s > 1.6 && time_s < 2.5) {
            EXPECT_FALSE(torque.determines(row)) << time_s;
        } else if (time_s < 1.5 || time_s > 2.6) {
            EXPECT_TRUE(torque.determines(row)) << time_s;
        }
    }
    EXPECT_LT(torque.determined_rows(), torque.rows);
    EXPECT_TRUE(series_of(fitter.series(), recording, "load_angle").is_determined.empty());
}

// A step that changes the torque by less than its noise leaves nothing open.
TEST(ResidualSeries, AFineEncoderDeterminesEverySample) {
    const Recording recording = resting_drive(1e-7);
    const CauseFitter fitter(recording, {24, 1}, 1);
    EXPECT_EQ(fitter.determined_rows(), static_cast<double>(fitter.data_rows()));
}

TEST(ResidualSeries, SamplesThatDetermineNothingHaveNoResidual) {
    Recording recording = resting_drive(2e-3);
    const CauseFitter fitter(recording, {24, 1}, 1);
    const ResidualSeries& torque = series_of(fitter.series(), recording, "motor_torque");
    const BenchKnowledge bench = undescribed_bench(recording);
    const Hypothesis nominal = nominal_hypothesis(bench);
    const Eigen::VectorXd residuals = fitter.data_residuals({&nominal, 1});
    for (std::size_t row = 0; row < torque.rows; ++row) {
        if (torque.determines(row)) continue;
        EXPECT_EQ(residuals[static_cast<Eigen::Index>(torque.first_row + row)], 0.0);
    }
}

}  // namespace
}  // namespace capstan::gap
