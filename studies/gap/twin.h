#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A number that a twin can be given: what a calibration fits. All are positive.
struct TwinParameter {
    std::string name;
    std::string unit;
    std::string meaning;
    double nominal = 0.0;
};

/// What a model says that the bench should have measured in one run.
struct TwinRun {
    std::vector<std::vector<double>> values;  // channels x samples; empty for what the model does not predict
    std::vector<double> sliding_fraction;     // samples: fraction of nodes that slide; empty if not asked for
    int unsolved_steps = 0;                   ///< torque not met or motion pattern not verified
};

/// A model of a recorded bench, moved by what drove the bench.
class Twin {
  public:
    virtual ~Twin() = default;

    virtual const std::vector<TwinParameter>& parameters() const = 0;
    /// Time at the start of each run in which the model cannot be compared, because what happened before is
    /// not known.
    virtual double unscored_s() const { return 0.0; }
    /// Moves the model through the recording's run `run` (its index), from rest under pretension. `values`:
    /// one per parameter. Throws InvalidInput if they make no bench.
    virtual TwinRun run(std::size_t run, std::span<const double> values) const = 0;
};

/// What the twin's parameters are before anything is fitted.
std::vector<double> nominal_values(const Twin& twin);

/// The friction rule depends on the length of a segment (E4); from about 100 segments on it hardly does.
inline constexpr int twin_segments = 100;

/// The twin of the recording's kind of bench; `recording` must outlive it. Throws InvalidInput if the driven
/// channels determine no motion, or if there is no model of such a bench.
std::unique_ptr<Twin> make_twin(const Recording& recording, int segments = twin_segments);

}  // namespace capstan::gap
