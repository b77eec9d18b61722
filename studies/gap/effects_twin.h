#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "capstan/calibration/twin.h"
#include "capstan/effects/bench_effects.h"
#include "capstan/effects/sensor_faults.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording.h"
#include "capstan/rig/bench_simulation.h"

namespace capstan::gap {

/// Everything that a bench with effects can be given.
struct BenchNumbers {
    // In parts of what the sidecar says.
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    /// Where the conduit bends: the curvature of its first and its last third in parts of that of the middle
    /// third. The wrap stays as it is.
    double bend_at_motor_ratio = 1.0;
    double bend_at_load_ratio = 1.0;
    /// The load pulley's radius in parts of what was read off the motion, which stretched cables shorten.
    double load_radius_ratio = 1.0;
    BenchEffects effects;
    /// By channel. Of a channel that drives the bench only the offset counts.
    std::map<std::string, SensorFaults> sensor_faults;
    /// A number that follows a condition of the runs: it changes by `linear c + squared c^2`, where c goes
    /// from -1 to 1 over the range of the condition. Or one that differs between runs as nobody stated.
    struct Following {
        enum class What {
            friction,    ///< logarithm of the friction
            pretension,  ///< logarithm of the pretension
            zero,        ///< zero of a channel's sensor, in its unit
        };
        What what = What::friction;
        std::string channel{};
        std::string condition{};
        double middle = 0.0;
        double half_range = 1.0;
        double linear = 0.0;
        double squared = 0.0;
        /// In place of a condition: the change in each run, by its number. In any other run it is their mean.
        std::map<int, double> of_runs{};

        double change_in(const RecordedRun& run) const;
        double mean_change() const;  ///< of of_runs
    };
    std::vector<Following> follows;

    /// The numbers under the run's conditions.
    BenchNumbers in_run(const RecordedRun& run) const;
    /// What holds for another recording: numbers that differ between runs have their mean.
    BenchNumbers in_other_runs() const;

    double zero_of(const std::string& channel) const;
    void change(const Following& each, double by);

    /// A path with its wrap moved between its thirds.
    std::vector<CurvaturePiece> routing(const std::vector<CurvaturePiece>& described) const;

    /// A rotor on its cables oscillates at tens of hertz. It is simulated at every sample whatever the
    /// stride.
    bool rings() const { return effects.of<Inertia>().motor_kg_m2 > 0.0; }
};

struct EffectsTwinOptions {
    /// Of each cable of a pair. A single cable gets twice as many, because the tension at its held end
    /// collects the error of every segment. E18 has no stiction rule that would need more.
    int segments = 50;
    /// From one predicted sample to the next. In between a step ends where a driven channel turns.
    int stride = 1;
    bool reports_sliding_fraction = false;
};

/// The recorded bench with these numbers, and the run that moves it.
struct MovedBench {
    std::size_t run = 0;
    BenchNumbers numbers;
};

/// A recorded bench of known geometry with effects (BenchSimulation), moved by the recording's driven
/// channels.
class EffectsTwin {
  public:
    /// `recording` must outlive it. Throws InvalidInput for a bench whose geometry is not known, or driven
    /// channels that determine no motion.
    EffectsTwin(const Recording& recording, const EffectsTwinOptions& options);

    /// The same bench, moved by other inputs: one set for each run of the recording.
    EffectsTwin moved_by(std::vector<DrivenInputs> inputs) const;

    /// The samples of a run that are predicted: 0, stride, 2 stride...
    int samples(std::size_t run) const;
    int stride() const { return options_.stride; }
    const EffectsTwinOptions& options() const { return options_; }

    /// channels x predicted samples; empty for driven channels.
    TwinRun run(std::size_t run, const BenchNumbers& numbers) const;
    /// Up to bench_lanes benches at once; each the same bits as alone, if all of them or none ring. Without
    /// sensor faults.
    std::vector<TwinRun> run_each(std::span<const MovedBench> moved) const;

    /// What `run` predicts, as faulty sensors read it.
    TwinRun with_faults(std::size_t run, const TwinRun& predicted,
                        const std::map<std::string, SensorFaults>& faults) const;

  private:
    struct Reader {
        std::size_t channel = 0;
        std::function<double(const BenchSimulations&, int bench)> read;
    };
    std::vector<Reader> readers_of(const RecordedRun& run) const;
    /// The samples to which a run is simulated: those predicted, and where a driven channel turns between.
    std::vector<int> stops_of(std::size_t run) const;
    void find_stops();
    void align_load_angle(std::size_t run, TwinRun& twin) const;

    const Recording& recording_;
    EffectsTwinOptions options_;
    // Of each run.
    std::vector<DrivenInputs> inputs_;
    std::vector<std::vector<int>> stops_;
};

}  // namespace capstan::gap
