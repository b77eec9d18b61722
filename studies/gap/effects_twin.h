#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "capstan/effects/bench_effects.h"
#include "capstan/effects/sensor_faults.h"
#include "capstan/gap/driven_inputs.h"
#include "capstan/gap/recording.h"
#include "capstan/gap/twin.h"

namespace capstan::gap {

/// Everything that a bench with effects can be given.
struct BenchNumbers {
    // In parts of what the sidecar says.
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    BenchEffects effects;
    std::map<std::string, SensorFaults> sensor_faults;  // by channel
};

struct EffectsTwinOptions {
    int segments = 50;  ///< E18 has no stiction rule that would need more
    int stride = 1;     ///< every how manieth sample a step goes to
};

/// A recorded bench of known geometry with effects (BenchSimulation), moved by the recording's driven
/// channels.
class EffectsTwin {
  public:
    /// `recording` must outlive it. Throws InvalidInput for a bench whose geometry is not known, or driven
    /// channels that determine no motion.
    EffectsTwin(const Recording& recording, const EffectsTwinOptions& options);

    /// The samples of a run that are predicted: 0, stride, 2 stride...
    int samples(std::size_t run) const;
    int stride() const { return options_.stride; }

    /// channels x predicted samples; empty for driven channels.
    TwinRun run(std::size_t run, const BenchNumbers& numbers) const;

  private:
    const Recording& recording_;
    EffectsTwinOptions options_;
    std::vector<DrivenInputs> inputs_;
};

}  // namespace capstan::gap
