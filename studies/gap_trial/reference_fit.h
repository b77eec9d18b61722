#pragma once

#include <optional>
#include <vector>

#include "capstan/gap_trial/trial_answer.h"
#include "capstan/gap_trial/trial_case.h"
#include "capstan/recording/recording.h"

namespace capstan::gap_trial {

/// What is left of a gap when the model is given the true cause, and only that: the engine's form of it
/// (which is not the form it was simulated with), its numbers and the nominal ones fitted as a diagnosis fits
/// them. The shrinkage that a diagnosis can claim is judged against this. None where the label names no
/// effect that the engine has.
std::optional<std::vector<ChannelRms>> reference_fit(const Recording& recording, const CaseLabel& label);

}  // namespace capstan::gap_trial
