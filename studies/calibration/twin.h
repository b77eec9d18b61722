#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A number of a twin that a calibration can fit. All are positive.
struct TwinParameter {
    std::string name;
    std::string unit;
    std::string meaning;
    double nominal = 0.0;
};

/// What a model predicts for one run.
struct TwinRun {
    std::vector<std::vector<double>> values;  // channels x samples; empty for what the model does not predict
    std::vector<double> sliding_fraction;     // samples: fraction of nodes that slide; empty if not asked for
    int unsolved_steps = 0;                   ///< torque not met or motion pattern not verified
};

/// A model of a recorded bench, driven by the inputs of the recording.
class Twin {
  public:
    virtual ~Twin() = default;

    virtual const std::vector<TwinParameter>& parameters() const = 0;
    /// The time at the start of each run that is not compared, because the motion before it is unknown.
    virtual double unscored_s() const { return 0.0; }
    /// Moves the model through the recording's run `run` (its index), from rest under pretension. `values`:
    /// one per parameter. Throws InvalidInput if no bench
    /// has such values.
    virtual TwinRun run(std::size_t run, std::span<const double> values) const = 0;
};

/// The twin's parameters before a fit.
std::vector<double> nominal_values(const Twin& twin);

/// The friction rule depends on the length of a segment (E4); above about 100 segments the result changes by
/// less than 1%.
inline constexpr int twin_segments = 100;

/// The twin of the recording's kind of bench; `recording` must outlive it. Throws InvalidInput if the driven
/// channels determine no motion, or if a model of such a bench does not exist.
std::unique_ptr<Twin> make_twin(const Recording& recording, int segments = twin_segments);

/// Twins of benches whose geometry is known (E1-E8, E15-E17). Parameters: dynamic_friction, static_friction,
/// axial_stiffness, pretension (one factor on what the sidecar says of each run).
std::unique_ptr<Twin> make_pull_pull_twin(const Recording& recording, int segments);
std::unique_ptr<Twin> make_single_cable_twin(const Recording& recording, int segments);

/// The signs of a drive's channels relative to the motor angle, estimated from the recording.
struct DriveOrientation {
    double load_per_motor_angle = 1.0;  ///< slope of the load angle over the motor angle
    double motor_torque_sign = 1.0;     ///< +1 if a positive torque turns the motor angle up
    double load_torque_sign = 1.0;      ///< +1 if the load torque adds to the motor's with its sign
};

/// Uses that the motor torque works against friction and carries the load. Of a channel that was not recorded
/// the ratio and the sign are 1. Throws InvalidInput if the motion shows no ratio or no friction.
DriveOrientation drive_orientation(const Recording& recording);

/// Twin of a drive whose geometry is not known, as a pull-pull pair (E15-E17) with all wrap and friction in
/// one exponent and the motor pulley's radius in the units: motor_angle and load_torque drive it, it predicts
/// motor_torque and, up to its zero, load_angle. Parameters: friction_exponent (mu_d times wrap angle),
/// stiffness (of one cable at the motor pulley), pretension (torque of one cable's pretension about it),
/// speed_ratio.
std::unique_ptr<Twin> make_lumped_drive_twin(const Recording& recording);

/// Reads a run's inputs by channel name and collects what a model predicts for its other channels.
class PredictedChannels {
  public:
    PredictedChannels(const Recording& recording, const RecordedRun& run, const DrivenInputs& inputs)
        : recording_(recording), run_(run), inputs_(inputs) {
        twin_.values.resize(recording.channels.size());
    }

    /// The channel's input at a sample; the channel must be driven.
    double driven(std::string_view channel, int sample) const {
        const auto index = static_cast<std::size_t>(*recording_.channel(channel));
        return inputs_.values[index][static_cast<std::size_t>(sample)];
    }

    /// Puts a prediction where the recording has such a channel and does not drive it.
    void predict(std::string_view channel, int sample, double value) {
        const std::optional<int> index = recording_.channel(channel);
        if (!index || run_.drives(channel)) return;
        std::vector<double>& values = twin_.values[static_cast<std::size_t>(*index)];
        if (values.empty()) values.resize(run_.time_s.size());
        values[static_cast<std::size_t>(sample)] = value;
    }

    void count_unsolved() { ++twin_.unsolved_steps; }
    TwinRun take() { return std::move(twin_); }

  private:
    const Recording& recording_;
    const RecordedRun& run_;
    const DrivenInputs& inputs_;
    TwinRun twin_;
};

}  // namespace capstan::gap
