#pragma once

#include "capstan/gap_trial/rig_bench.h"
#include "capstan/gap_trial/trial_motion.h"

namespace capstan::gap_trial {

/// A session as a hand or an experiment makes it: `runs` runs of 8 to 13 s, irregular and band-limited, with
/// rests. A pair is driven by torques against a lock or a hand, of which at least one run is moved; a single
/// cable by its motor angle; a drive by its motor angle and, at a level of its own for each run, its load
/// torque.
std::vector<TrialRun> draw_rig_session(const Rig& rig, int runs, TrialStream& draws);

}  // namespace capstan::gap_trial
