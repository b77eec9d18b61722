#pragma once

#include "capstan/gap_trial/lumped_bench.h"
#include "capstan/gap_trial/trial_bench.h"

namespace capstan::gap_trial {

/// A bench and the level at which it works.
struct Rig {
    TrialBench bench;
    double pretension_N = 0.0;  ///< as the laboratory sets it

    /// The torques at which one cable of a pair falls slack.
    double motor_torque_scale_Nm() const;
    double load_torque_scale_Nm() const;
};

/// How a rig is simulated: chains of so many masses, whatever the cable's length and stiffness are.
constexpr LumpedBenchOptions rig_simulation(int masses) {
    return {.masses = masses, .damping_fraction = 0.4};
}

/// A rig of its own: length, bends, radii, friction (an exponent of 0.35 to 1.1), stiffness, pretension,
/// noise and sensors are drawn. `kind` is one of the `rig_` kinds.
Rig draw_rig(BenchKind kind, double noise_factor, TrialStream& draws);

}  // namespace capstan::gap_trial
