#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "capstan/cable/cable_cut.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"
#include "session_with_effects.h"

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

// The drive's motor turns to and fro, and its encoder has this step.
Recording drive_to_and_fro(double step_rad) {
    Recording recording = resting_drive(step_rad);
    for (RecordedRun& run : recording.runs) {
        for (std::size_t sample = 0; sample < run.time_s.size(); ++sample) {
            const double turned_rad = 0.3 * std::sin(2.0 * run.time_s[sample]);
            run.values[static_cast<std::size_t>(*recording.channel("motor_angle"))][sample] =
                step_rad * std::round(turned_rad / step_rad);
        }
    }
    return recording;
}

TEST(ResidualSeries, AnEncoderThatMayHaveTurnedAtAnySampleNearAReversalDoesNotDetermineTheTorqueThere) {
    const double step_rad = 2e-3;
    const Recording recording = drive_to_and_fro(step_rad);
    const CauseFitter fitter(recording, {24, 1}, 1);
    const ResidualSeries& torque = series_of(fitter.series(), recording, "motor_torque");
    const RecordedRun& run = recording.runs[torque.run];
    std::size_t open = 0;
    for (std::size_t row = 0; row < torque.rows; ++row) {
        const double time_s = run.time_s[static_cast<std::size_t>(torque.first_sample) + row];
        const double below_the_peak_rad = 0.3 * (1.0 - std::abs(std::sin(2.0 * time_s)));
        if (below_the_peak_rad > 3.0 * step_rad) {
            EXPECT_TRUE(torque.determines(row)) << time_s;
        }
        if (below_the_peak_rad < 0.5 * step_rad) {
            EXPECT_FALSE(torque.determines(row)) << time_s;
        }
        open += torque.determines(row) ? 0 : 1;
    }
    EXPECT_GT(open, 0U);
    EXPECT_TRUE(series_of(fitter.series(), recording, "load_angle").is_determined.empty());
    const Recording finer = drive_to_and_fro(1e-7);
    const CauseFitter of_finer(finer, {24, 1}, 1);
    EXPECT_EQ(of_finer.determined_rows(), static_cast<double>(of_finer.data_rows()));
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

std::vector<double> residuals_of(const Recording& recording, const EffectsTwin& twin,
                                 const ResidualSeries& series) {
    const std::vector<double> predicted = twin.run(series.run, {}).values[series.channel];
    std::vector<double> residuals;
    for (std::size_t row = 0; row < series.rows; ++row) {
        const std::size_t sample = static_cast<std::size_t>(series.first_sample) + row;
        residuals.push_back(recording.runs[series.run].values[series.channel][sample] - predicted[sample]);
    }
    return residuals;
}

// What a stiff cable makes of the noise of an angle that a hand moves is not a gap: a channel's scale holds it.
TEST(ResidualSeries, NoiseOfADrivenAngleIsPartOfTheScaleOfWhatItMoves) {
    Recording exact = exact_session({}, coarse_twin);
    std::erase_if(exact.runs, [](const RecordedRun& run) { return run.output != OutputKind::handle; });
    for (Channel& channel : exact.channels) channel.noise_std.reset();
    const double without =
        series_of(residual_series(exact, EffectsTwin(exact, coarse_twin)), exact, "load_torque").scale;

    Recording noisy = exact;
    const auto angle = static_cast<std::size_t>(*exact.channel("load_angle"));
    constexpr double noise_rad = 4e-3;
    noisy.channels[angle].noise_std = noise_rad;
    std::vector<double> left;
    for (unsigned seed = 1; seed <= 9; ++seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal(0.0, noise_rad);
        noisy.runs = exact.runs;
        for (double& value : noisy.runs.at(0).values[angle]) value += normal(random);
        const EffectsTwin twin(noisy, coarse_twin);
        const std::vector<ResidualSeries> all = residual_series(noisy, twin);
        const ResidualSeries& torque = series_of(all, noisy, "load_torque");
        EXPECT_GT(torque.scale, 1.5 * without);
        const std::vector<double> residuals = residuals_of(noisy, twin, torque);
        const double squares =
            std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
        left.push_back(std::sqrt(squares / static_cast<double>(residuals.size())) / torque.scale);
    }
    std::nth_element(left.begin(), left.begin() + 4, left.end());
    // One large noise at a reversal moves the torque of a complete stroke, so that single recordings scatter.
    EXPECT_NEAR(left[4], 1.0, 0.4);
}

double standard_deviation(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / count - mean * mean);
}

// A run whose load is held, and channels without noise.
Recording held_run() {
    Recording recording = exact_session({}, coarse_twin);
    std::erase_if(recording.runs, [](const RecordedRun& run) { return run.output != OutputKind::locked; });
    recording.runs.resize(1);
    for (Channel& each : recording.channels) each.noise_std.reset();
    return recording;
}

// The floor of a channel that reads the same all the time.
double floor_of_constant(Recording recording, const std::string& channel) {
    std::vector<double>& values =
        recording.runs.front().values[static_cast<std::size_t>(*recording.channel(channel))];
    std::fill(values.begin(), values.end(), 0.4);
    return series_of(residual_series(recording, EffectsTwin(recording, coarse_twin)), recording, channel).scale;
}

// What the motor's torque changes along the cables together, at the motor.
double motor_change_N(const Recording& recording) {
    const auto torque = static_cast<std::size_t>(*recording.channel("motor_torque"));
    return standard_deviation(recording.runs.front().values[torque]) / recording.nominal->motor_radius_m;
}

// Friction may stop a motion before it reaches a held load. The error of how far it gets is a fraction of what
// it would bring there (E67), so that a load that feels nothing has a floor, too.
TEST(ResidualSeries, TheFloorOfAHeldLoadGoesWithTheMotorsTorque) {
    Recording recording = held_run();
    const NominalBench& bench = *recording.nominal;
    const double brought_Nm = motor_change_N(recording) * bench.load_radius_m *
                              std::exp(-bench.dynamic_friction * wrap_rad(bench.curvature));
    EXPECT_NEAR(floor_of_constant(recording, "load_torque"), 0.02 * brought_Nm, 1e-6 * brought_Nm);

    recording.runs.front().output = OutputKind::handle;
    EXPECT_LT(floor_of_constant(recording, "load_torque"), 1e-3 * brought_Nm);
}

// So has a tension sensor that the motion does not reach: what would arrive there falls over the bends between
// (E1), and each of two cables carries a half of it.
TEST(ResidualSeries, TheFloorOfATensionGoesWithWhatTheMotionWouldBringToItsPlace) {
    const Recording recording = held_run();
    const NominalBench& bench = *recording.nominal;
    for (const TensionSensor& sensor : recording.tension_sensors) {
        const double turned_rad = wrap_between_rad(bench.curvature, 0.0, sensor.position_m);
        const double brought_N =
            0.5 * motor_change_N(recording) * std::exp(-bench.dynamic_friction * turned_rad);
        EXPECT_NEAR(floor_of_constant(recording, sensor.channel), 0.007 * brought_N, 1e-6 * brought_N);
    }
    EXPECT_FALSE(recording.tension_sensors.empty());
}

}  // namespace
}  // namespace capstan::gap
