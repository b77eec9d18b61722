#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/gap/diagnosis.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/model_comparison/left_over.h"
#include "capstan/model_comparison/model_comparison.h"

namespace capstan::bench_model {

using gap::FittedInterval;
using gap::FittedNumber;

/// Where a model comes from.
struct ModelOrigin {
    std::string recording;
    std::vector<int> runs;  ///< that it was fitted to
    std::string program_version;
    std::string verdict;  ///< of the diagnosis, in one sentence
};

/// An effect of the catalogue with all of its parameters.
struct ModelEffect {
    std::string name;
    std::string variant;
    std::vector<FittedNumber> numbers;
};

/// What is wrong with the sensor of a channel; faults by their names in the catalogue, without "sensor_".
struct ModelSensor {
    std::string channel;
    std::vector<FittedNumber> faults;
};

/// Numbers that follow a condition of the runs: how much they change from the middle to the end of the
/// condition's range. "friction_log" and "pretension_log" are logarithms, "zero_of_CHANNEL" is in the
/// channel's unit.
struct ModelFollowing {
    std::string condition;
    double middle = 0.0;      ///< of the condition, in its own unit
    double half_range = 1.0;  ///< the same
    std::vector<FittedNumber> changes;
};

/// A cause that the verdict names.
struct ModelCause {
    std::string effect;
    std::string variant;
    std::string component;
    std::string end;
    double probability = 0.0;  ///< that it is present
};

/// The law of what the model leaves of a channel.
struct ModelLaw {
    std::string channel;
    std::string motion;  ///< the channels that it is a function of
    std::string load;    ///< empty: none
    std::string unit;    ///< of the three channels
    std::string motion_unit;
    std::string load_unit;
    residual_law::ResidualLaw law;
    std::string sentence;
};

/// What a diagnosis found, as a model that predicts other runs of the same bench.
struct BenchModel {
    ModelOrigin origin;
    BenchMode recorded_mode = BenchMode::pull_pull;  ///< of the recordings that it is a model of
    /// The bench before the diagnosis, with channels as they are recorded. Where the geometry is unknown, an
    /// equivalent bench.
    gap::BenchEquivalence description;
    int segments = 40;            ///< of a cable; a single cable has twice as many
    double sample_rate_Hz = 0.0;  ///< of the recording; 0: not known
    /// Standard deviation of a tension reading: of the noisiest tension sensor, or of a torque sensor over
    /// the radius of its pulley where no tension was recorded; 0: not known.
    double tension_noise_N = 0.0;
    /// In parts of what the description, or a run's pretension, says.
    FittedNumber friction_ratio;
    FittedNumber stiffness_ratio;
    FittedNumber pretension_ratio;
    /// Of a conduit whose routing is not known: how much its first and its last third are bent, in parts of
    /// the middle third.
    FittedNumber bend_at_motor_ratio{"bend_at_motor_ratio", "", 1.0, {}};
    FittedNumber bend_at_load_ratio{"bend_at_load_ratio", "", 1.0, {}};
    /// Of a drive of unknown geometry: the load pulley's radius in parts of what the description says.
    FittedNumber load_radius_ratio{"load_radius_ratio", "", 1.0, {}};
    std::vector<ModelEffect> effects;
    std::vector<ModelSensor> sensors;
    std::vector<ModelFollowing> follows;
    std::vector<ModelCause> causes;
    std::vector<gap::RankedEffect> ranked;  ///< best first
    std::vector<ModelLaw> laws;

    bool is_of_unknown_geometry() const;
    /// What the bench is simulated with.
    gap::BenchNumbers numbers() const;
};

/// The model that a diagnosis found. `left`: what it leaves of the runs that were diagnosed.
BenchModel model_of(const model_comparison::DiagnosedSplit& diagnosed,
                    const std::vector<model_comparison::LeftOver>& left, const ModelOrigin& origin,
                    const gap::DiagnosisOptions& options);

}  // namespace capstan::bench_model
