#pragma once

#include "capstan/gap_trial/withheld_effect.h"

namespace capstan::gap_trial {

/// The effects that a rig of the kind can withhold: those of the catalogue that are not nuisances and that
/// its channels can show. Friction laws, creep and sensor faults have other forms than the engine's and than
/// those of the other kinds of trial.
std::vector<EffectMaker> rig_effects(BenchKind kind);

/// Friction, pretension or a sensor's zero that follows a condition of the runs.
WithheldEffect draw_varying_number(const EffectSetting& setting, const std::string& condition,
                                   TrialStream& draws);

}  // namespace capstan::gap_trial
