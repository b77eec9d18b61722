#pragma once

#include <string>
#include <vector>

#include "capstan/bench/waveform.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/solver/pull_pull.h"

namespace capstan::bench {

enum class MotorDrive { torque, angle };

/// The load on the load pulley.
enum class LoadKind {
    locked,  ///< its angle stays zero
    handle,  ///< its angle is prescribed
    torque,  ///< it takes a torque from the transmission; zero: free
    spring,  ///< a spring to a wall that may move
};

/// A pull-pull bench and its inputs.
struct BenchPlan {
    std::string name;
    CableSpecification cable;  ///< each of the pair
    Pulleys pulleys;
    MotorDrive motor_drive = MotorDrive::torque;
    Waveform motor;  ///< N m or rad
    LoadKind load_kind = LoadKind::locked;
    Waveform load;  ///< N m of a torque; rad of a handle or a wall
    double load_stiffness_Nm_per_rad = 0.0;
    double sample_rate_Hz = 0.0;
    double duration_s = 0.0;
    /// effect catalogue x parameters; as the catalogue's `absent` where an effect is not there.
    EffectValues effects = absent_effects();

    int samples() const;  ///< beyond the first, which is at rest
    PullPullInputs inputs_at(double time_s) const;
};

/// Everything wrong with the plan, each with the key it belongs to; empty when it can run.
std::vector<KeyProblem> problems_of(const BenchPlan& plan);

}  // namespace capstan::bench
