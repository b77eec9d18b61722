#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/cable/cable.h"

namespace capstan {

/// The kind of bench.
enum class BenchMode {
    pull_pull,     ///< two cables between a motor pulley and a load pulley
    single_cable,  ///< one cable: its input end on the motor pulley, its far end held
    lumped_drive,  ///< a cable drive whose geometry is not known, seen from its two shafts
    capstan_band,  ///< a band round a drum, both ends of the band measured
};

/// What held the load pulley of a run.
enum class OutputKind { locked, handle, unknown };

enum class CableName { a, b };

/// A strain sensor on a cable, `position_m` from the motor end.
struct TensionSensor {
    std::string channel;
    CableName cable = CableName::a;
    double position_m = 0.0;
};

/// One measured quantity, in SI units.
struct Channel {
    std::string name;
    std::string unit;
    std::optional<double> noise_std;  ///< of one sample, where the sidecar states it
    std::optional<double> step;       ///< of an encoder or converter, where the sidecar states it
};

struct RecordedRun {
    int number = 0;
    std::string protocol;
    double session_start_s = 0.0;
    std::optional<double> pretension_N;
    OutputKind output = OutputKind::unknown;
    std::vector<std::string> driven;          ///< channels that a model takes as inputs
    std::vector<double> time_s;               // samples
    std::vector<std::vector<double>> values;  // channels x samples
    /// What was set for the run and stays during it, as the sidecar names it, such as roll_deg.
    std::map<std::string, double> conditions{};

    int samples() const { return static_cast<int>(time_s.size()); }
    bool drives(std::string_view channel) const;
};

/// How roughly nominal numbers are known: standard deviations of their logarithms. 0: stated as a value.
struct NominalSpread {
    double friction = 0.0;
    double stiffness = 0.0;
    double pretension = 0.0;  ///< of all runs alike
};

/// What a laboratory knows of its bench before it looks at the recording.
struct NominalBench {
    std::vector<CurvaturePiece> curvature;
    double motor_radius_m = 0.0;
    double load_radius_m = 0.0;
    double axial_stiffness_N = 0.0;
    double dynamic_friction = 0.0;
    double static_friction = 0.0;
    NominalSpread spread{};
    double rotor_inertia_kg_m2 = 0.0;        ///< with the motor pulley; 0: not stated
    double load_pulley_inertia_kg_m2 = 0.0;  ///< 0: not stated
    /// Of a drive of unknown geometry whose load torque was not recorded: of the spring that is taken to hold
    /// the load pulley; 0: the load is recorded.
    double load_compliance_rad_per_Nm = 0.0;
    /// Where the motor's current was recorded instead of its torque; 0: a torque sensor.
    double torque_constant_Nm_per_A = 0.0;
    /// It moves as a drive or band does whose geometry nobody stated.
    bool is_equivalent = false;
};

/// The numbers of a bench's cable that a fit or a parameter file may change.
struct CableNumbers {
    double dynamic_friction = 0.0;
    double static_friction = 0.0;  ///< raised to `dynamic_friction` where it is below
    double axial_stiffness_N = 0.0;
    double pretension_N = 0.0;
};

/// The model's cable on this routing with these numbers.
CableSpecification cable_specification(const std::vector<CurvaturePiece>& routing,
                                       const CableNumbers& numbers, int segments);

struct Recording;

/// The recording with other values, without the channels that are empty in a run. What is known of the noise
/// and step of the channels is dropped. `values`: runs x channels x samples.
Recording with_values(Recording recording, std::vector<std::vector<std::vector<double>>> values);

/// For what takes the nominal numbers as they are. Throws InvalidInput where the sidecar states one as a
/// range or not at all; `instead`, in a sentence, is what else would do.
void require_stated_numbers(const Recording& recording, const std::string& instead);

/// A session on a bench: several runs, all with the same channels.
struct Recording {
    std::string name;
    BenchMode mode = BenchMode::pull_pull;
    double sample_rate_Hz = 0.0;
    std::vector<Channel> channels;
    std::vector<TensionSensor> tension_sensors;
    std::optional<NominalBench> nominal;  ///< none where the geometry is not known
    std::vector<RecordedRun> runs;        ///< in the order they were made
    /// The nominal numbers are not stated but fitted to the recording, and so is each run's zero of the load
    /// angle.
    bool nominal_is_fitted = false;
    /// A pair of cables whose numbers nobody stated.
    bool is_undescribed_drive() const { return nominal_is_fitted && mode == BenchMode::pull_pull; }
    /// What the sidecar does not state and was taken instead, and keys that look misspelled; sentences.
    std::vector<std::string> assumptions;

    /// Index in `channels`, if the channel exists.
    std::optional<int> channel(std::string_view channel_name) const;
    int samples() const;
    /// Whether a model has to say what the channel reads in some run, because the run does not drive it.
    bool is_predicted(std::string_view channel_name) const;
};

}  // namespace capstan
