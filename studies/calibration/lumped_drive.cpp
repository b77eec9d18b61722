#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/twin.h"
#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"
#include "capstan/solver/pull_pull.h"

namespace capstan::gap {

namespace {

enum DriveParameter : std::size_t { friction_exponent, stiffness, drive_pretension, speed_ratio };

// Without stiction (mu_s alone cannot be identified) few segments are enough.
constexpr int lumped_segments = 40;
// The motion before a run is unknown. After this time the first motion has overwritten its effect.
constexpr double forgetting_s = 1.0;
// Where a fit starts: a moderate friction exponent, and a stiffness that gives a few degrees at the torque of
// the friction loop.
constexpr double start_exponent = 0.5;
constexpr double start_give_rad = 0.05;

const std::vector<double>& samples_of(const Recording& recording, const RecordedRun& run,
                                      const char* channel) {
    return run.values[static_cast<std::size_t>(*recording.channel(channel))];
}

// Sum over all runs of (x - run's mean) (y - run's mean).
double covariation(const Recording& recording, const char* x, const char* y) {
    double sum = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const std::vector<double>& a = samples_of(recording, run, x);
        const std::vector<double>& b = samples_of(recording, run, y);
        const double mean_a = mean_of(a);
        const double mean_b = mean_of(b);
        for (std::size_t sample = 0; sample < a.size(); ++sample)
            sum += (a[sample] - mean_a) * (b[sample] - mean_b);
    }
    return sum;
}

// Work of the motor torque over all runs, and the path along which it was done.
struct LoopWork {
    double work_J = 0.0;
    double path_rad = 0.0;
};

LoopWork loop_work(const Recording& recording) {
    LoopWork loop;
    for (const RecordedRun& run : recording.runs) {
        const std::vector<double>& angle = samples_of(recording, run, channel::motor_angle);
        const std::vector<double>& torque = samples_of(recording, run, channel::motor_torque);
        // Whatever is stored in a constant torque comes back; only the part of friction counts.
        const double mean_torque = mean_of(torque);
        for (std::size_t sample = 1; sample < angle.size(); ++sample) {
            const double turned = angle[sample] - angle[sample - 1];
            loop.work_J += (0.5 * (torque[sample] + torque[sample - 1]) - mean_torque) * turned;
            loop.path_rad += std::abs(turned);
        }
    }
    return loop;
}

// Of load torque and motor torque over all samples, from their means over all of them. What holds the load
// may change within a run, as a spring, or from run to run, as a weight; the means of runs alone follow other
// differences between them, as a conduit that is bent more and more.
double load_covariation(const Recording& recording) {
    std::vector<double> motor;
    std::vector<double> load;
    for (const RecordedRun& run : recording.runs) {
        const std::vector<double>& motor_Nm = samples_of(recording, run, channel::motor_torque);
        const std::vector<double>& load_Nm = samples_of(recording, run, channel::load_torque);
        motor.insert(motor.end(), motor_Nm.begin(), motor_Nm.end());
        load.insert(load.end(), load_Nm.begin(), load_Nm.end());
    }
    const double mean_motor_Nm = mean_of(motor);
    const double mean_load_Nm = mean_of(load);
    double sum = 0.0;
    for (std::size_t sample = 0; sample < motor.size(); ++sample)
        sum += (motor[sample] - mean_motor_Nm) * (load[sample] - mean_load_Nm);
    // Under one load that never changes, the signs of the mean torques must agree.
    return sum != 0.0 ? sum : mean_motor_Nm * mean_load_Nm;
}

const Recording& with_all_channels(const Recording& recording) {
    for (const char* channel : channel::all) {
        if (!recording.channel(channel))
            throw InvalidInput({recording.name + ": a lumped drive is calibrated with the channel " +
                                channel + ", which was not recorded; `capstan diagnose` does without it"});
    }
    return recording;
}

class LumpedDrive final : public Twin {
  public:
    explicit LumpedDrive(const Recording& recording)
        : recording_(with_all_channels(recording)), orientation_(drive_orientation(recording)) {
        for (const RecordedRun& run : recording.runs) {
            if (!run.drives(channel::motor_angle) || !run.drives(channel::load_torque))
                throw InvalidInput(
                    {recording.name + ": a lumped drive is driven by motor_angle and load_torque"});
            inputs_.push_back(driven_inputs(recording, run));
        }
        const LoopWork loop = loop_work(recording);
        const double friction_Nm = std::abs(loop.work_J) / loop.path_rad;
        parameters_ = {
            {"friction_exponent", "", "mu_d times the wrap angle of one cable", start_exponent},
            {"stiffness", "N m/rad", "of one cable, about the motor pulley", friction_Nm / start_give_rad},
            {"pretension", "N m", "of one cable, about the motor pulley",
             friction_Nm / (2.0 * start_exponent)},
            {"speed_ratio", "", "motor angle over load angle",
             1.0 / std::abs(orientation_.load_per_motor_angle)}};
    }

    const std::vector<TwinParameter>& parameters() const override { return parameters_; }
    double unscored_s() const override { return forgetting_s; }

    TwinRun run(std::size_t run, std::span<const double> values) const override {
        const RecordedRun& recorded = recording_.runs[run];
        const PullPull pair = pair_of(values);
        PredictedChannels channels(recording_, recorded, inputs_[run]);
        PullPullState state = pair.at_rest();
        const double start_rad = channels.driven(channel::motor_angle, 0);
        const double way = orientation_.load_per_motor_angle < 0.0 ? -1.0 : 1.0;
        std::vector<double> load_angle_rad;  // samples
        for (int sample = 0; sample < recorded.samples(); ++sample) {
            const double torque_Nm =
                orientation_.load_torque_sign * channels.driven(channel::load_torque, sample);
            const PullPullReport report =
                pair.advance(state, {MotorAngle{channels.driven(channel::motor_angle, sample) - start_rad},
                                     LoadTorque{torque_Nm}});
            if (!report.solved()) channels.count_unsolved();
            channels.predict(channel::motor_torque, sample,
                             orientation_.motor_torque_sign * pair.motor_torque_Nm(state));
            load_angle_rad.push_back(way * state.load_angle_rad);
        }
        const double zero_rad = load_angle_zero_rad(recorded, load_angle_rad);
        for (int sample = 0; sample < recorded.samples(); ++sample)
            channels.predict(channel::load_angle, sample,
                             zero_rad + load_angle_rad[static_cast<std::size_t>(sample)]);
        return channels.take();
    }

  private:
    PullPull pair_of(std::span<const double> values) const {
        // One radian of wrap, so that the friction coefficient is the exponent.
        const Cable cable(cable_specification({{1.0, 1.0}},
                                              {.dynamic_friction = values[friction_exponent],
                                               .axial_stiffness_N = values[stiffness],
                                               .pretension_N = values[drive_pretension]},
                                              lumped_segments));
        return {cable, cable, {1.0, values[speed_ratio]}};
    }

    // The zero of the load angle is unknown, so its mean over a run is set to the measured one.
    double load_angle_zero_rad(const RecordedRun& recorded, const std::vector<double>& predicted_rad) const {
        if (!recording_.channel(channel::load_angle)) return 0.0;
        return mean_of(samples_of(recording_, recorded, channel::load_angle)) - mean_of(predicted_rad);
    }

    const Recording& recording_;
    DriveOrientation orientation_;
    std::vector<DrivenInputs> inputs_;
    std::vector<TwinParameter> parameters_;
};

}  // namespace

DriveOrientation drive_orientation(const Recording& recording) {
    const auto has = [&](const char* channel) { return recording.channel(channel).has_value(); };
    const bool has_loop = has(channel::motor_angle) && has(channel::motor_torque);
    DriveOrientation orientation;
    if (has(channel::motor_angle) && has(channel::load_angle)) {
        const double motor_motion = covariation(recording, channel::motor_angle, channel::motor_angle);
        orientation.load_per_motor_angle =
            motor_motion > 0.0
                ? covariation(recording, channel::motor_angle, channel::load_angle) / motor_motion
                : 0.0;
    }
    const double work_J = has_loop ? loop_work(recording).work_J : 1.0;
    if (orientation.load_per_motor_angle == 0.0 || work_J == 0.0)
        throw InvalidInput({recording.name +
                            ": motor and load do not move together, so the drive's ratio and "
                            "signs cannot be read off the recording"});
    orientation.motor_torque_sign = work_J > 0.0 ? 1.0 : -1.0;
    if (!has(channel::load_torque)) return orientation;
    orientation.load_torque_sign = orientation.motor_torque_sign;
    if (has(channel::motor_torque)) {
        if (load_covariation(recording) < 0.0) orientation.load_torque_sign *= -1.0;
    } else if (covariation(recording, channel::motor_angle, channel::load_torque) < 0.0) {
        orientation.load_torque_sign = -1.0;  // what holds the load pulls back
    }
    return orientation;
}

std::unique_ptr<Twin> make_lumped_drive_twin(const Recording& recording) {
    return std::make_unique<LumpedDrive>(recording);
}

}  // namespace capstan::gap
