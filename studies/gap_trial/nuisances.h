#pragma once

#include <string>
#include <vector>

#include "capstan/gap_trial/rig_bench.h"
#include "capstan/gap_trial/true_effects.h"

namespace capstan::gap_trial {

/// Something that every rig has a little of, so that naming it is neither right nor wrong.
struct Nuisance {
    std::string effect;  ///< canonical name: sensor_offset, pulley_friction, param_mu, param_K, param_T0
    std::string where;   ///< channel of a zero, end of a friction; empty for a nominal number
    double size = 0.0;   ///< in the channel's unit; N m; logarithm of the true ratio
};

/// A zero error of each torque and tension sensor (0.5 to 3% of the torques at which a cable falls slack, 2
/// to 8% of the pretension) and Coulomb friction of both pulleys (0.5 to 4%); of a drive up to a third of its
/// load. Adds them to `effects`.
std::vector<Nuisance> add_nuisances(const Rig& rig, TrueEffects& effects, TrialStream& draws);

/// Friction, stiffness and pretension 7 to 20% off what the laboratory states.
std::vector<Nuisance> add_wrong_nominals(TrueEffects& effects, TrialStream& draws);

}  // namespace capstan::gap_trial
